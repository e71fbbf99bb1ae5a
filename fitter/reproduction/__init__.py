"""The figures and the table of the paper, drawn from fits."""
