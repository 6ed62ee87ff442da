"""Engines in which lagnet runs what it has exported."""
