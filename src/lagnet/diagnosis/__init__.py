"""From recordings and a nominal model to a verdict: where they differ, and what physics was left out."""
