"""What a page is made from: the findings of a diagnosis, a fleet over time, a replay of recordings."""
