"""The catalogue of left-out physics: one physical cause a file, all answering the calls of `effects.effect.Effect`."""
