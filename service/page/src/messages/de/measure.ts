// A person measured from the front and from the side: the pictures, the camera, and what came out.
import type { Messages } from "../catalogue";
import { plural } from "../figures";

export const measure: Messages["measure"] = {
  title: "Eine Person messen",
  lead: "Zwei Bilder, von vorn und von der Seite, und die Körperhöhe.",
  noHeight: "Die Körperhöhe wird gebraucht: Bilder allein sagen nicht, wie groß jemand ist.",
  weight: "Mit dem Gewicht werden die Maße besser, wenn Sie es wissen.",
  noPictures: "Keine Bilder zur Hand?",
  trySample: "Beispielbilder nehmen",
  leftOut: (count) =>
    `Der Scan hat ${plural(count, { one: "ein weiteres Bild", other: `${count} weitere Bilder` })}. Hier wird nur je eines von vorn und von der Seite verwendet; der Rest bleibt weg.`,
  rules: {
    title: "So werden die Maße gut",
    list: [
      "Enge Kleidung oder Unterwäsche, Haare hochgebunden, keine Schuhe.",
      "Das Telefon aufrecht und gerade in Höhe des Bauchs, zwei bis drei Meter entfernt; abgestellt, oder von jemandem gehalten.",
      "Vom Kopf bis zu den Füßen im Bild, mit etwas Platz ringsum.",
      "Licht von der Seite der Kamera, und eine Wand in anderer Farbe als Haut und Kleidung.",
      "Atmen Sie aus, stehen Sie locker, ziehen Sie den Bauch nicht ein. Beide Bilder vom selben Platz aus: Drehen Sie sich, nicht die Kamera.",
      "Bilder aus der Kamera-App des Telefons, als Datei gewählt, nennen ihr Objektiv: Dann muss nichts angenommen werden.",
    ],
  },
  noDetector: {
    title: "Dieser Dienst kann die Person nicht selbst finden",
    why: "Die Erkennung ist nicht installiert: Ohne Klicks werden Bilder weder geprüft noch gemessen. Klicken Sie die Gelenke im Editor; er misst nach einem Bild.",
    openFront: "Das Bild von vorn dort öffnen",
    toEditor: "Zum Editor",
  },
  views: {
    front: { label: "Von vorn", picture: "Bild von vorn" },
    side: { label: "Von der Seite", picture: "Bild von der Seite" },
    back: { label: "Von hinten", picture: "Bild von hinten" },
    other: { label: "Aus anderer Richtung", picture: "Bild aus anderer Richtung" },
  },
  ofPicture: (picture) => `Das ${picture}`,
  viewNumber: (view, number) => `${view} ${number}`,
  place: {
    stances: {
      front: "Sehen Sie in die Kamera. Die Füße schulterbreit auseinander, die Arme deutlich vom Körper weg.",
      side: "Drehen Sie sich zur Seite, gleich zu welcher. Die Füße zusammen, die Arme nach vorn gestreckt, der Blick geradeaus.",
    },
    drawn: {
      front: "Gezeichnet: eine Person von vorn, Arme und Beine auseinander",
      side: "Gezeichnet: eine Person von der Seite, Beine zusammen, Arme nach vorn gestreckt",
    },
    take: "Aufnehmen",
    takeAgain: "Neu aufnehmen",
    takeNamed: (picture) => `Aufnehmen: ${picture}`,
    choose: "Datei wählen",
    chooseOther: "Andere Datei",
    chooseNamed: (picture) => `Datei wählen: ${picture}`,
    looking: "Das Bild wird angesehen …",
    good: "Gut zum Messen",
    told: (view, said) => `${view}: ${said}`,
  },
  findings: { blocks: "Bitte neu aufnehmen", harms: "Könnte besser sein" },
  unusable: "Dieses Bild lässt sich nicht messen",
  todo: {
    height: "Körperhöhe angeben",
    add: (picture) => `${picture} hinzufügen`,
    again: (picture) => `${picture} neu aufnehmen`,
    noDetector: "Hier können keine Punkte vorgeschlagen werden",
  },
  submit: "Messen",
  anyway: {
    title: "Trotzdem messen?",
    ask: (pictures) =>
      `${plural(pictures.length, { one: `Das ${pictures[0]} sollte`, other: `Das ${pictures.join(" und das ")} sollten` })} neu aufgenommen werden. Trotzdem messen?`,
    back: "Zurück",
  },
  camera: {
    label: (picture) => `Kamera: ${picture}`,
    sees: "Was die Kamera sieht",
    taken: "Aufgenommen",
    chooseInstead: (picture) => `Stattdessen eine Datei wählen: ${picture}`,
    countdown: "Selbstauslöser",
    useBack: "Hintere Kamera verwenden",
    useFront: "Vordere Kamera verwenden",
    stop: "Anhalten",
    takeIn: (seconds) => `In ${seconds} aufnehmen`,
    troubles: {
      forbidden: "Diese Seite darf die Kamera nicht verwenden. Erlauben Sie es in den Einstellungen des Browsers, oder wählen Sie eine Datei.",
      none: "Es wurde keine Kamera gefunden. Wählen Sie stattdessen eine Datei.",
      used: "Etwas anderes verwendet die Kamera. Schließen Sie es, oder wählen Sie eine Datei.",
      unusable: "Die Kamera lässt sich hier nicht verwenden. Wählen Sie stattdessen eine Datei.",
      noPicture: "Die Kamera gab kein Bild. Versuchen Sie es noch einmal, oder wählen Sie eine Datei.",
    },
  },
  level: {
    level: "Gerade",
    left: "Drehen Sie das Telefon nach links",
    right: "Drehen Sie das Telefon nach rechts",
    down: "Die Kamera sieht nach oben: Neigen Sie sie nach unten",
    up: "Die Kamera sieht nach unten: Neigen Sie sie nach oben",
  },
  quality: {
    contradicted: "Ein Bild zeigt keine Person, wie es soll: Nehmen Sie es neu auf.",
    differentPeople: "Die Bilder widersprechen sich: Trauen Sie diesen Maßen nicht.",
    poor: "Schlecht: Ein Bild sollte neu aufgenommen werden. Siehe unten.",
    fair: "Mittel: Die Bilder könnten besser sein. Siehe unten.",
    good: "Gut: An den Bildern ist nichts auszusetzen, und sie passen zueinander.",
    rarely: (share) => `So verschieden wie diese sind Bilder einer Person nur in ${share} der Fälle. Prüfen Sie, ob beide dieselbe Person zeigen, gleich gekleidet.`,
    nearlyAlways: "Bilder einer Person sind fast immer verschiedener als diese.",
    often: (share) => `So verschieden wie diese sind Bilder einer Person in ${share} der Fälle.`,
  },
  proposed: {
    all: (picture) => `alle im ${picture}`,
    some: (count, picture) => `${count} im ${picture}`,
  },
  told: {
    faults: {
      "person-not-found": "In diesem Bild wurde niemand gefunden. Die ganze Person soll darin sein, aufrecht, in gutem Licht und unverdeckt.",
      "points-too-close": "Die Person ist in diesem Bild zu klein. Gehen Sie näher heran.",
      "too-few-points": "In diesem Bild ist zu wenig von der Person zu sehen. Die ganze Person soll darin sein, vom Kopf bis zu den Füßen.",
    },
    warnings: {
      "ambiguous-limb-facing": "Nach diesem Bild könnte ein Arm oder ein Bein ebenso gut andersherum geneigt sein. Wenn Sie es neu aufnehmen, stehen Sie, wie die guten Bilder es zeigen.",
      "different-people": "Die Bilder scheinen verschiedene Personen zu zeigen. Prüfen Sie, ob beide dieselbe Person zeigen, gleich gekleidet.",
      "left-and-right-may-be-swapped": "Links und rechts sind vielleicht verwechselt. Nehmen Sie das Bild neu auf, so gedreht, wie die guten Bilder es zeigen.",
      "low-silhouette-overlap": "Der Körper deckt wenig von der Person im Bild. Nehmen Sie es neu auf, vor einer Wand in anderer Farbe.",
      "nobody-found": "In diesem Bild wurde niemand gefunden. Die ganze Person soll darin sein, aufrecht, in gutem Licht und unverdeckt.",
      "other-view": "Die Person steht anders gedreht als verlangt. Nehmen Sie das Bild neu auf: von vorn mit dem Gesicht zur Kamera, von der Seite um ein Viertel gedreht, und nicht gespiegelt.",
      "segmentation-doubtful": "Die Person hebt sich kaum vom Hintergrund ab. Nehmen Sie das Bild neu auf, vor einer Wand in anderer Farbe.",
      "several-people": "Mehrere Personen sind in diesem Bild; die größte wird gemessen. Es soll niemand anderes darin sein.",
      "shoulders-and-hips-disagree": "Links und rechts sind vielleicht verwechselt. Nehmen Sie das Bild neu auf, so gedreht, wie die guten Bilder es zeigen.",
    },
    verdicts: {
      implausible: "Ein Körper wurde bestimmt, aber dieses Bild widerspricht ihm. Nehmen Sie es neu auf: eine Person allein, ganz im Bild, so wie die guten Bilder es zeigen.",
      no_person: "In diesem Bild ist keine Person zu sehen. Nehmen Sie es neu auf, mit der ganzen Person darin, in gutem Licht und unverdeckt.",
    },
  },
};
