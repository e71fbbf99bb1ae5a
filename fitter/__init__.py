"""Human shape, pose, light and reflectance from one image (Guan et al., ICCV 2009).

Three lines fit a picture; :mod:`fitter.library` goes on from there::

    from fitter import Click, FitRequest, Gender, fit
    clicks = {"left_hip": Click(x=412, y=530), ...}
    result = fit(FitRequest(image=picture, clicks=clicks, gender=Gender.FEMALE, height_m=1.70))

Names are imported when they are first used (``__init__.pyi`` lists them), so that a part of the
package costs no more than it needs.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
