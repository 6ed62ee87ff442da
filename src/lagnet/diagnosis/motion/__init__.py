"""Diagnosis on motion: recordings of commands and positions against rollouts of the commands alone."""
