"""What several commands share: lines and progress on the terminal, options of many values, robots and replays."""
