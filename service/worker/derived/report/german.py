"""The report in German."""

from typing import Final

from api_schemas.derivation_kinds.report import Language
from fitter.vocabulary.choices import Gender, ViewKind
from fitter.vocabulary.measurements import Group
from fitter.vocabulary.outcomes import FocalLengthSource, Outcome, Verdict
from service.worker.derived.report.german_measures import MEASUREMENTS
from service.worker.derived.report.german_remarks import REMARKS
from service.worker.derived.report.wording import (
    Figures,
    FitWords,
    LightWords,
    PictureWords,
    TableWords,
    Wording,
)

GERMAN: Final = Wording(
    language=Language.GERMAN,
    figures=Figures(
        decimal_sign=",",
        date="{day}. {month} {year}",
        months=(
            *("Januar", "Februar", "März", "April", "Mai", "Juni", "Juli"),
            *("August", "September", "Oktober", "November", "Dezember"),
        ),
    ),
    title="Körpermaße",
    scan_title="Körpermaße",
    footnote=(
        "Gemessen am aufrechten Körper, an rechtem Arm und Bein. Bei Menschen in anliegender "
        "Kleidung liegt der wahre Wert in 95 von 100 Fällen im Bereich. Dies ist kein "
        "Medizinprodukt."
    ),
    genders={Gender.FEMALE: "Frau", Gender.MALE: "Mann"},
    subtitle="{about}, aus einem Bild",
    scan_subtitle="{about}, aus {count} Bildern",
    measurements=MEASUREMENTS,
    table=TableWords(
        number="Nr.",
        measurement="Maß",
        value="Wert",
        unit="Einheit",
        interval="Bereich (95 %)",
        not_known="nicht bekannt",
        given="angegeben",
        exact="genau",
        withheld="Es sind keine Maße angegeben; die Gründe stehen unten.",
        figures={
            "chest_girth": "Brust",
            "waist_girth_smallest": "Taille",
            "hip_girth": "Hüfte",
            "weight": "Gewicht",
        },
        groups={
            Group.OVERALL: "Körperhöhe und Gewicht",
            Group.GIRTHS: "Umfänge",
            Group.LENGTHS: "Längen",
            Group.HEIGHTS: "Höhen über dem Boden",
            Group.BREADTHS: "Breiten und Tiefen",
        },
    ),
    light=LightWords(
        heading="Licht und Haut",
        not_estimated="Nicht bestimmt: Der Körper wurde allein nach dem Umriss gefunden.",
        lamp="Lampe",
        from_right="{degrees}° von rechts",
        from_left="{degrees}° von links",
        from_above="{degrees}° von oben",
        from_below="{degrees}° von unten",
        far_away="weit entfernt",
        away="{metres} m entfernt",
        skin="Haut",
        throws_back="wirft {percent} % des Lichts zurück",
        gloss="Glanz",
        mirrors="spiegelt {percent} % davon",
        all_round="Licht von überall",
        of_lamp="{percent} % des Lampenlichts",
    ),
    fit=FitWords(
        fit="Wie sicher es ist",
        scan="Wie sicher es ist",
        pictures="Die Bilder",
        how_it_ended="Ergebnis",
        ended={
            Outcome.CONVERGED: "Der Körper passt so gut zum Bild, wie er kann.",
            Outcome.EVALUATION_LIMIT: (
                "Die Suche wurde an ihrer Grenze beendet, bevor sie fertig war; dies ist der "
                "bisher beste Körper."
            ),
            Outcome.POOR_FIT: (
                "Der Körper deckt die Person schlecht; Punkte, Geschlecht oder Ausschnitt sind "
                "vielleicht falsch. Verlassen Sie sich nicht auf diese Maße."
            ),
        },
        outcomes={
            Outcome.CONVERGED: "gefunden",
            Outcome.EVALUATION_LIMIT: "an der Grenze beendet",
            Outcome.POOR_FIT: "passt schlecht",
        },
        verdicts={
            Verdict.PLAUSIBLE: "Plausibel",
            Verdict.IMPLAUSIBLE: "Nicht plausibel",
            Verdict.NO_PERSON: "Keine Person",
        },
        contradicted={
            Verdict.IMPLAUSIBLE: (
                "Ein Körper wurde bestimmt, aber das Bild lässt sich nicht messen: Die Gründe "
                "stehen unten."
            ),
            Verdict.NO_PERSON: "An den Punkten zeigt das Bild keine Person.",
        },
        overlap="Deckung",
        overlap_of="Körper und Person decken sich zu {percent} %",
        overlap_in_view="Deckung {percent} %",
        lens="Objektiv",
        lens_of="{millimetres} mm bezogen auf Kleinbild, {source}",
        lens_sources={
            FocalLengthSource.CALLER: "wie angegeben",
            FocalLengthSource.EXIF_35MM: "wie das Bild sagt",
            FocalLengthSource.EXIF_SENSOR: "wie das Bild sagt",
            FocalLengthSource.ASSUMED: "angenommen",
        },
        picture="Bild",
        pixels="{width} × {height} Pixel",
        agreement="Übereinstimmung",
        agreement_of=(
            "{percent} % der Bilderpaare einer Person unterscheiden sich mehr als diese."
        ),
        views={
            ViewKind.FRONT: "Von vorn",
            ViewKind.SIDE: "Von der Seite",
            ViewKind.BACK: "Von hinten",
            ViewKind.OTHER: "Andere Ansicht",
        },
    ),
    remarks=REMARKS,
    pictures=PictureWords(
        overlay="Der Körper über dem Bild",
        sides={
            "from the camera": "Von der Kamera aus",
            "from the right of the picture": "Von rechts im Bild",
            "from behind": "Von hinten",
            "from the left of the picture": "Von links im Bild",
        },
        tapes="Wo gemessen wird",
        tape_sides={"front": "Von vorn", "side": "Von der Seite", "back": "Von hinten"},
        tapes_note="Die Nummern stehen in der Tabelle vor den Maßen.",
    ),
)
