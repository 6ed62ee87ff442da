"""Effects with memory: bristles, gaps and elastic transmissions."""
