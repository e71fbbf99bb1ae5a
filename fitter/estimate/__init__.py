"""Bodies without a picture: the most probable body of whoever has the known measurements.

Section 3.1 starts every fit from the mean person of a gender and height. The same holds for any
measurements: the shape space is a population, its coefficients β ~ N(0, I), and what is known of
somebody conditions it.
"""
