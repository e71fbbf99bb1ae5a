"""Human shape, pose, light and reflectance from one image (Guan et al., ICCV 2009).

Three lines fit a picture, or several of one person; :mod:`fitter.library` goes on from there::

    from fitter import Click, FitRequest, Gender, Person, View, fit
    view = View(image=picture, clicks={"left_hip": Click(x=412, y=530), ...})
    result = fit(FitRequest(person=Person(gender=Gender.FEMALE, height_m=1.70), views=(view,)))

Names are imported when they are first used (``__init__.pyi`` lists them), so that a part of the
package costs no more than it needs.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
