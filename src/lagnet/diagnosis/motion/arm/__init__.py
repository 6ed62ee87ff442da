"""The whole arm at once: rollouts by its commands with all joints coupled, fits to them, and intervals."""
