"""Masses that the model lacks or has wrong, and a base that is not level."""
