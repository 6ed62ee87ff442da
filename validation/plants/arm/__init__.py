"""The true arm: bodies, gears, friction with memory, controllers; nothing here imports lagnet."""
