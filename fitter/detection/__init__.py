"""Finding people in a picture: BlazePose's two networks and the use made of their output.

Bazarevsky et al., "BlazePose: On-device Real-time Body Pose Tracking" (CVPR Workshop 2020), and
Grishchenko et al., "BlazePose GHUM Holistic" (CVPR Workshop 2022). The weights come from a package;
see :mod:`fitter.detection.weights`.
"""
