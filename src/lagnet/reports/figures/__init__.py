"""Plots and drawings of a page: `figure` says what a plot is, `decimation` and `timeline` which samples it needs."""
