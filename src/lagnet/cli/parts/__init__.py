"""Parts of one command each: what `diagnose`, `demo` and `data inspect` do beside parsing their options."""
