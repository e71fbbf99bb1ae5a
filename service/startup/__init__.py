"""How every process begins: its settings, and what is wrong with them."""
