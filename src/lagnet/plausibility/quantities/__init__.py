"""What several checks ask of a model: derivatives, energies, bodies, terms beside a reference, recordings in limits."""
