// The draft as the API wants it, and back.
import type { FitOptions, Gender, InitialPoseRequest } from "../api/types";
import { namedPoints } from "../points/coco";
import { NO_POINTS, skipRest } from "../points/placed";
import type { Points } from "../points/placed";
import { hasProposed } from "../points/proposed";
import { begin } from "../points/timeline";
import { clothing, cues, facing, focalLength, light, person, picture, points, selected, surroundings, timeline } from "./draft";
import { NOBODY, heightM, heightTexts, tapeMeasurements, tapeTexts, weightKg, weightText } from "./person";
import type { Person } from "./person";

type Subject = Pick<
  FitOptions,
  "gender" | "height_m" | "weight_kg" | "measurements" | "points" | "focal_length_35mm" | "limb_facing"
>;

/** The diagonal of 35 mm film, to which equivalent focal lengths refer. */
const FILM_DIAGONAL_MM = 43.27;

/** Who is in the picture, as far as it is known. */
export function describedPerson(gender: Gender, known: Person): Pick<Subject, "gender" | "height_m" | "weight_kg" | "measurements"> {
  const height = heightM(known);
  const weight = weightKg(known);
  return {
    gender,
    ...(height === null ? {} : { height_m: height }),
    ...(weight === null ? {} : { weight_kg: weight }),
    measurements: tapeMeasurements(known),
  };
}

export function subjectOf(
  gender: Gender,
  known: Person,
  clicked: Points,
  lens: number | null,
  facings: FitOptions["limb_facing"],
): Subject {
  return {
    ...describedPerson(gender, known),
    ...(lens === null ? {} : { focal_length_35mm: lens }),
    points: Object.fromEntries(
      Object.entries(clicked.placed).map(([name, { x, y, hidden, proposed }]) => [
        name,
        { x, y, visibility: hidden ? 1 : 2, ...(proposed ? { source: "proposal" } : {}) },
      ]),
    ) as FitOptions["points"],
    limb_facing: facings,
  };
}

export function draftedSubject(): Subject | null {
  const { gender } = person.value;
  if (gender === null) return null;
  return subjectOf(gender, person.value, points.value, focalLength.value, facing.value);
}

/** How the light and the outline are to be taken, and by what the body is found. */
export function draftedChoices(): Pick<FitOptions, "cues" | "clothing" | "light"> {
  const known = light.value !== null || surroundings.value !== "uniform";
  return {
    cues: cues.value,
    ...(clothing.value === "auto" ? {} : { clothing: clothing.value }),
    ...(known ? { light: { ...light.value, surroundings: surroundings.value } } : {}),
  };
}

export function draftedInitialPose(subject: Subject, width: number, height: number, imageId: string | null): InitialPoseRequest {
  const where = imageId === null ? { image_size: { width, height } } : { image_id: imageId };
  return { ...subject, ...where };
}

/** Take up a person, as of an earlier request; what is left out is unknown. */
export function loadPerson(asked: Partial<Pick<FitOptions, "gender" | "height_m" | "weight_kg" | "measurements">>): void {
  const { units } = person.value;
  person.value = {
    ...NOBODY,
    gender: asked.gender ?? null,
    units,
    ...heightTexts(asked.height_m ?? null, units),
    weight: weightText(asked.weight_kg ?? null, units),
    tape: tapeTexts(asked.measurements ?? {}, units),
  };
}

/** Take up what an earlier fit was asked for. */
export function loadDraft(asked: FitOptions): void {
  loadPerson(asked);
  const placed = Array.isArray(asked.points) ? {} : namedPoints(asked.points);
  const loaded: Points = { ...NO_POINTS, placed };
  timeline.value = begin(hasProposed(loaded) ? skipRest(loaded) : loaded);
  selected.value = null;
  focalLength.value = lensOf(asked);
  facing.value = asked.limb_facing ?? {};
  cues.value = asked.cues ?? "SES";
  clothing.value = asked.clothing ?? "auto";
  light.value = asked.light?.azimuth_deg != null ? asked.light : null;
  surroundings.value = asked.light?.surroundings ?? "uniform";
}

/** As on 35 mm film, whichever way it was said; null if it was not. */
function lensOf(asked: FitOptions): number | null {
  const shown = picture.value;
  if (asked.focal_length_px == null || !shown) return asked.focal_length_35mm ?? null;
  return (asked.focal_length_px * FILM_DIAGONAL_MM) / Math.hypot(shown.width, shown.height);
}
