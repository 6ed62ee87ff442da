"""Diagnosis on motion: recordings of commands and positions, judged by rollouts of the commands alone."""
