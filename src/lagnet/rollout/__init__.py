"""Forward motion of servo-driven joints with exact stick and slip, compiled and batched over windows."""
