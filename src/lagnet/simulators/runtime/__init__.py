"""Modules that are written beside exported models and run there without lagnet; replay runs the very same ones."""
