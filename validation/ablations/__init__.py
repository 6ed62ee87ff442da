"""What each rule of a verdict buys: the same concealed plants, diagnosed with one rule taken out at a time."""
