"""How every process starts: its settings, and what is wrong with them."""
