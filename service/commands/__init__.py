"""The commands of ``maquette``, one module each."""
