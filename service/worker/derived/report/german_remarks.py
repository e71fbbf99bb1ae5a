"""What was assumed and what to look at, in German."""

from typing import Final

from service.worker.derived.report.wording import RemarkWords

_POINTS: Final = {
    "left_shoulder": "Linke Schulter",
    "right_shoulder": "Rechte Schulter",
    "left_elbow": "Linker Ellenbogen",
    "right_elbow": "Rechter Ellenbogen",
    "left_wrist": "Linkes Handgelenk",
    "right_wrist": "Rechtes Handgelenk",
    "left_hip": "Linke Hüfte",
    "right_hip": "Rechte Hüfte",
    "left_knee": "Linkes Knie",
    "right_knee": "Rechtes Knie",
    "left_ankle": "Linkes Fußgelenk",
    "right_ankle": "Rechtes Fußgelenk",
    "head_top": "Scheitel",
    "nose": "Nase",
    "left_eye": "Linkes Auge",
    "right_eye": "Rechtes Auge",
    "left_ear": "Linkes Ohr",
    "right_ear": "Rechtes Ohr",
    "chin": "Kinn",
    "neck": "Halsgrube",
    "left_heel": "Linke Ferse",
    "right_heel": "Rechte Ferse",
    "left_toe": "Linke Zehen",
    "right_toe": "Rechte Zehen",
}
"""As the page calls them (``service/page/src/messages/de/points.ts``)."""

_WARNINGS: Final = {
    "ambiguous-limb-facing": (
        "Das Bild passt etwa ebenso gut, wenn manche Gliedmaßen anders herum geneigt sind, auf "
        "die Kamera zu oder von ihr weg. Sagen Sie, wie es ist, und werten Sie das Bild noch "
        "einmal aus."
    ),
    "body-outside-picture": (
        "Die Person reicht über den Rand des Bildes. Was außerhalb liegt, ist aus dem Rest "
        "erschlossen."
    ),
    "clothes-not-loose": (
        "Rumpf und Oberschenkel zeigen viel von der Hautfarbe der Person, wie in Unterwäsche oder "
        "Badekleidung. Wenn nichts Weites sie verdeckt, wählen Sie anliegende Kleidung: So können "
        "Umfänge um mehrere Zentimeter zu klein ausfallen."
    ),
    "cut-off": (
        "Die Person reicht bis an den Rand des Bildes oder darüber hinaus: Punkte, die nicht im "
        "Bild sind, fehlen."
    ),
    "different-people": (
        "Die Bilder scheinen verschiedene Personen zu zeigen. Prüfen Sie die Bilder und ihre "
        "Punkte, oder lassen Sie eine Auswertung weg."
    ),
    "given-contradicted": (
        "Ein angegebener Wert widerspricht den Bildern und der Körperhöhe. Prüfen Sie die Angaben "
        "und ihre Einheiten."
    ),
    "implausible": (
        "Diese Maße sind vielleicht die von niemandem: Das Bild widerspricht dem Körper."
    ),
    "left-and-right-may-be-swapped": (
        "Beide Augen sind zu sehen, aber links und rechts liegen wie von hinten: Sie sind "
        "vielleicht vertauscht. Gemeint sind die Seiten der Person."
    ),
    "limbs-crossed": (
        "Arme oder Beine kreuzen sich im Bild: Sehen Sie nach, ob links und rechts stimmen."
    ),
    "low-silhouette-overlap": (
        "Der Körper deckt wenig von der ausgeschnittenen Person. Prüfen Sie die Punkte und links "
        "und rechts, oder verwenden Sie eine Maske."
    ),
    "no-person": (
        "Diese Maße sind vielleicht die von niemandem: An den Punkten ist keine Person zu sehen."
    ),
    "nobody-found": "In dem Bild wurde niemand gefunden: Klicken Sie die Punkte selbst.",
    "other-view": (
        "In einem der Bilder steht die Person anders zur Kamera als angegeben. Prüfen Sie die "
        "Ansicht, ob links und rechts die Seiten der Person sind, und ob das Bild gespiegelt ist."
    ),
    "person-too-small": (
        "Die Person ist so klein, dass die Maße leiden: Schneiden Sie das Bild auf sie zu, oder "
        "nehmen Sie ein größeres."
    ),
    "sandbox": (
        "Dies ist eine Testumgebung: Das Ergebnis ist das eines Beispiels, was auch gesendet wurde."
    ),
    "seen-from-behind": (
        "Die Person scheint von hinten gesehen zu sein: Sehen Sie nach, ob links und rechts ihre "
        "eigenen Seiten sind."
    ),
    "segmentation-doubtful": (
        "Die Person hebt sich in der Farbe nicht vom Hintergrund ab; der Umriss ist kaum mehr als "
        "eine erste Schätzung. Eine eigene Maske würde helfen."
    ),
    "several-people": (
        "Mehrere Personen wurden gefunden, die größte ist genommen. Klicken Sie einen Punkt der "
        "Person, die gemeint ist."
    ),
    "shading-not-used": (
        "Vom Körper ist zu wenig zu sehen, das richtig belichtet ist und nicht am Rand liegt: Die "
        "Schattierung sagt nichts, das Ergebnis beruht allein auf dem Umriss."
    ),
    "shoulders-and-hips-disagree": (
        "Nach den Schultern ist die Person von der einen Seite zu sehen, nach den Hüften von der "
        "anderen: Bei einem Paar sind links und rechts vielleicht vertauscht. Gemeint sind die "
        "Seiten der Person."
    ),
    "transparency-over-white": (
        "Das Bild ist zum Teil durchsichtig und wurde auf Weiß gelegt. Wenn der deckende Teil die "
        "Person ist, verwenden Sie ihn als Maske."
    ),
    "unusual-height": (
        "Diese Körperhöhe haben wenige. Der übrige Körper ist aus den üblichen Größen "
        "hochgerechnet, die Fehlerangaben sind weiter. Prüfen Sie Körperhöhe und Geschlecht."
    ),
}

_FINDINGS: Final = {
    "nobody-found": (
        "In diesem Bild wurde niemand gefunden. Die ganze Person soll darin sein, aufrecht, "
        "in gutem Licht und unverdeckt."
    ),
    "several-people": (
        "Mehrere Personen sind im Bild; die größte wird gemessen. Es soll niemand anderes "
        "darin sein."
    ),
    "cut-off": (
        "Die Person reicht bis an den Rand des Bildes oder darüber hinaus. Gehen Sie zurück "
        "oder drehen Sie die Kamera, bis rings um die Person Platz ist."
    ),
    "person-too-small": (
        "Die Person ist im Bild zu klein. Gehen Sie näher heran, bis sie das Bild füllt, oder "
        "schneiden Sie es auf sie zu."
    ),
    "picture-too-small": (
        "Das Bild hat zu wenige Pixel. Nehmen Sie das Bild, wie die Kamera es aufgenommen "
        "hat, keine Vorschau."
    ),
    "other-view": (
        "Die Person steht anders zur Kamera als verlangt. Von vorn: mit dem Gesicht zur "
        "Kamera. Von der Seite: um ein Viertel gedreht."
    ),
    "arms-against-trunk": (
        "Zwischen Arm und Rumpf ist kaum Hintergrund zu sehen. Die Arme sollen vom Körper "
        "abstehen, an den Hüften mindestens eine Handbreit."
    ),
    "clothes-loose": (
        "Weite Kleidung: Der Körper darunter ist geschätzt. Anliegende Kleidung oder das "
        "Gewicht machen die Maße sicherer."
    ),
    "skin-not-found": (
        "Weder Gesicht noch Hände zeigen die Hautfarbe der Person, oder das Bild hat keine "
        "Farben: Die Kleidung gilt als weit. Nehmen Sie ein farbiges Bild mit dem Gesicht, oder "
        "sagen Sie, wie die Kleidung sitzt."
    ),
    "covered": (
        "Etwas verdeckt oder berührt die Person oder sieht ihr ähnlich: Ein Teil des Umrisses "
        "zählt nicht, die Maße sind weniger sicher. Vor und neben der Person soll nichts und "
        "niemand sein."
    ),
    "not-standing": (
        "Die Person steht nicht gerade. Lassen Sie sie aufrecht und mit gestreckten Beinen stehen."
    ),
    "child": "Nach den Proportionen ist dies ein Kind. Gemessen werden können nur Erwachsene.",
    "blurred": (
        "Das Bild ist unscharf. Halten Sie die Kamera ruhig, stellen Sie auf die Person "
        "scharf, und sorgen Sie für mehr Licht."
    ),
    "too-dark": (
        "Die Person ist zu dunkel. Schalten Sie mehr Licht ein, von der Seite der Kamera und "
        "nicht hinter der Person."
    ),
    "too-bright": (
        "Ein großer Teil der Person ist überbelichtet. Belichten Sie kürzer: Tippen Sie auf "
        "dem Bildschirm der Kamera auf die Person, oder meiden Sie das grelle Licht."
    ),
    "camera-rolled": (
        "Die Person steht im Bild schräg. Halten Sie die Kamera gerade, und lassen Sie die "
        "Person aufrecht stehen."
    ),
    "camera-too-near": (
        "Die Kamera war zu nah. Gehen Sie auf 2,5 m oder mehr zurück und zoomen Sie heran."
    ),
    "contradicted": (
        "Das Bild widerspricht dem Körper. Sehen Sie nach, ob die Punkte auf den Gelenken "
        "einer einzigen Person liegen und eine Maske nur diese Person zeigt."
    ),
}

REMARKS: Final = RemarkWords(
    assumed="Was angenommen wurde",
    warned="Was Sie prüfen sollten",
    nothing="Nichts.",
    quantities={
        "height_m": "Körperhöhe",
        "focal_length_35mm": "Objektiv",
        "points": "Punkte",
        "outline": "Umriss",
    },
    values={"outer bound": "Äußere Grenze", **_POINTS},
    reasons={
        "height_m": "Angegeben ist keine; dies ist die wahrscheinlichste nach den Angaben.",
        "focal_length_35mm": "Weder Sie noch das Bild sagen, welches Objektiv es aufnahm.",
        "points": ("Die Erkennung hat sie vorgeschlagen; sie sind weniger sicher als Klicks."),
        "outline": (
            "Die Kleidung ist weit: Wo sie den Umriss bildet, ist der Körper darunter geschätzt; "
            "an bloßer Haut und anliegender Kleidung liegt er auf ihm. Mit anliegender Kleidung "
            "oder dem Gewicht werden die Maße sicherer."
        ),
    },
    warnings=_WARNINGS,
    findings=_FINDINGS,
)
