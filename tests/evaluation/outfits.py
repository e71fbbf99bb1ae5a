"""What people of the clothed series wear."""

from tests.evaluation.scene import Bottom, Cloth, Outfit, Pattern, Top

_DENIM = Cloth(colour=(0.045, 0.075, 0.16), ease_m=0.025, fall=0.06, fold_m=0.005)
_KHAKI = Cloth(colour=(0.2, 0.17, 0.1), ease_m=0.03, fall=0.05, fold_m=0.006)
_BLACK = Cloth(colour=(0.02, 0.02, 0.023), ease_m=0.03, fall=0.04, fold_m=0.006)

SHIRT_AND_TROUSERS = Outfit(
    top=Top(cloth=Cloth(colour=(0.55, 0.56, 0.57), ease_m=0.03, fall=0.16)),
    bottom=Bottom(cloth=_DENIM),
)
DRESS = Outfit(
    top=Top(
        cloth=Cloth(colour=(0.09, 0.13, 0.3), ease_m=0.035, fall=0.06, fold_m=0.009),
        sleeve=0.38,
        hem=0.25,
        neckline_m=0.05,
    )
)
STRIPED_SHIRT_AND_TROUSERS = Outfit(
    top=Top(
        cloth=Cloth(
            colour=(0.5, 0.5, 0.48),
            second_colour=(0.03, 0.05, 0.12),
            pattern=Pattern.STRIPES,
            ease_m=0.035,
            fall=0.14,
        )
    ),
    bottom=Bottom(cloth=_KHAKI),
)
BLOUSE_AND_SKIRT = Outfit(
    top=Top(
        cloth=Cloth(colour=(0.5, 0.42, 0.2), ease_m=0.03, fall=0.2, fold_m=0.005),
        sleeve=0.5,
        neckline_m=0.06,
        hem=0.5,
    ),
    bottom=Bottom(
        cloth=Cloth(colour=(0.14, 0.02, 0.05), ease_m=0.025, fall=-0.06, fold_m=0.01),
        waist=0.6,
        hem=0.3,
        skirt=True,
    ),
)
DRESS_OF_LINEN = Outfit(
    top=Top(
        cloth=Cloth(colour=(0.3, 0.32, 0.22), ease_m=0.045, fall=0.05, fold_m=0.009),
        sleeve=0.3,
        hem=0.27,
        neckline_m=0.05,
    )
)
BLOUSE_AND_TROUSERS = Outfit(
    top=Top(
        cloth=Cloth(colour=(0.3, 0.04, 0.06), ease_m=0.035, fall=0.14, fold_m=0.006),
        sleeve=0.55,
        neckline_m=0.05,
    ),
    bottom=Bottom(cloth=_BLACK, hem=0.1),
)
WIDE_SHIRT_AND_TROUSERS = Outfit(
    top=Top(cloth=Cloth(colour=(0.1, 0.25, 0.45), ease_m=0.05, fall=0.1, fold_m=0.008)),
    bottom=Bottom(cloth=_KHAKI),
)
CHECKED_SHIRT_AND_TROUSERS = Outfit(
    top=Top(
        cloth=Cloth(
            colour=(0.42, 0.42, 0.4),
            second_colour=(0.22, 0.03, 0.03),
            pattern=Pattern.CHECKS,
            ease_m=0.035,
            fall=0.13,
        ),
        sleeve=0.55,
    ),
    bottom=Bottom(cloth=_DENIM),
)
