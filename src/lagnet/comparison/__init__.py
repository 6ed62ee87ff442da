"""Several parameter sets of one robot against recordings: which explains them better, and what they cannot decide."""
