"""Contacts in other programs of harmonic balance: tmdsimpy (tmdsimpy.py), pyHarm (pyharm.py, which imports it)."""
