"""Contacts in other programs of harmonic balance.

tmdsimpy   a force of tmdsimpy (tmdsimpy.py)
pyharm     an element of pyHarm (pyharm.py), whose import needs pyHarm
"""

from . import tmdsimpy

__all__ = ["tmdsimpy"]
