"""What a finished fit is good for: other poses, motion, caricature."""
