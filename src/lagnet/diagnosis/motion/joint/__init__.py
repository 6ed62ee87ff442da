"""One joint on motion: hypotheses are compared on windows of its commands and positions, and fitted."""
