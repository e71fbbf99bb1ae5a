"""Human shape, pose, light and reflectance from one image (Guan et al., ICCV 2009)."""
