"""Many recordings, over robots and time: one diagnosis each, and what changed when. The only room that knows Dask."""
