"""Plants of another simulator than the one that all else here is tried on."""
