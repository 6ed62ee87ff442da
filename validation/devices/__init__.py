"""Training and batched parts on every device that JAX sees."""
