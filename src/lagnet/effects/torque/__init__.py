"""Friction, drag, springs and ripple: torques that act at one joint and depend on its own motion."""
