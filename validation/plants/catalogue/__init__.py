"""What may be hidden in a plant: draws, the physics they stand for, and what of it a recording can show."""
