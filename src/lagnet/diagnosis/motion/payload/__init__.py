"""A body that the last link carries, told from motion: rollouts of the whole arm, its fit, and its judgement."""
