"""Applications of a finished fit: other poses, motion, caricature."""
