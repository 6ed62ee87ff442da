"""A concealed fleet: which robots wear, which only warm up, and what else was changed."""
