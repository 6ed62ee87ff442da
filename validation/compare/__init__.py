"""Several parameter sets of one robot against recordings: right, wrong, undecided."""
