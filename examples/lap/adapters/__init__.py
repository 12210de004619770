"""Contacts in other programs of harmonic balance, with examples/lap on the PYTHONPATH.

tmdsimpy   a force of tmdsimpy (tmdsimpy.py)
pyharm     an element of pyHarm (pyharm.py), whose import needs pyHarm
cycles     what both have in common (cycles.py)
"""
