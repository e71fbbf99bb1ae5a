// The draft as the API wants it, and back.
import { batch } from "@preact/signals";
import type { FitRequest, Gender, InitialPoseRequest, ViewRequest } from "../api/types";
import { namedPoints } from "../points/named";
import { NO_POINTS, isEnough, skipRest } from "../points/placed";
import type { Points } from "../points/placed";
import { begin } from "../points/timeline";
import { cues, isAwaiting, person, views } from "./draft";
import type { DraftView } from "./draft";
import { NOBODY, heightM, heightTexts, tapeMeasurements, tapeTexts, weightKg, weightText } from "./person";
import type { Picture } from "./picture";

/** The diagonal of 35 mm film, to which equivalent focal lengths refer. */
const FILM_DIAGONAL_MM = 43.27;

type PersonRequest = Pick<FitRequest, "gender" | "height_m" | "weight_kg" | "measurements">;

/** Who is in the pictures, as far as it is known. */
export function personRequest(gender: Gender): PersonRequest {
  const known = person.value;
  const height = heightM(known);
  const weight = weightKg(known);
  return {
    gender,
    ...(height === null ? {} : { height_m: height }),
    ...(weight === null ? {} : { weight_kg: weight }),
    measurements: tapeMeasurements(known),
  };
}

/** What is asked of the person, whatever the pictures. */
export function wholeRequest(gender: Gender): Omit<FitRequest, "views"> {
  return { ...personRequest(gender), cues: cues.value };
}

/** Points that are still awaited are left to the service. */
export function viewRequest(view: DraftView): ViewRequest {
  const { view: kind, clothing } = view;
  return {
    ...(views.value.length > 1 ? { view: kind.value } : {}),
    ...(isAwaiting(view) ? { points: "auto" } : { points: pointsRequest(view), limb_facing: view.facing.value }),
    ...lensRequest(view),
    ...(clothing.value === "auto" ? {} : { clothing: clothing.value }),
  };
}

export function initialPoseRequest(view: DraftView, gender: Gender): InitialPoseRequest {
  const { picture, uploaded, facing } = view;
  const recorded = uploaded.value?.focal_length_35mm;
  return {
    ...personRequest(gender),
    image_size: { width: picture.width, height: picture.height },
    points: pointsRequest(view),
    limb_facing: facing.value,
    ...(recorded ? { focal_length_35mm: recorded } : {}),
    ...lensRequest(view),
  };
}

function lensRequest({ focalLength }: DraftView): { focal_length_35mm?: number } {
  return focalLength.value === null ? {} : { focal_length_35mm: focalLength.value };
}

function pointsRequest({ timeline }: DraftView): InitialPoseRequest["points"] {
  const { placed } = timeline.value.present;
  return Object.fromEntries(
    Object.entries(placed).map(([name, { x, y, hidden, proposed }]) => [name, { x, y, visibility: hidden ? 1 : 2, ...(proposed ? { source: "proposal" } : {}) }]),
  ) as InitialPoseRequest["points"];
}

/** Take up what was asked of a person; what is left out is unknown. */
export function loadPerson(asked: Partial<PersonRequest>): void {
  const { units } = person.value;
  person.value = {
    gender: asked.gender ?? NOBODY.gender,
    units,
    ...heightTexts(asked.height_m ?? null, units),
    weight: weightText(asked.weight_kg ?? null, units),
    tape: tapeTexts(asked.measurements ?? {}, units),
  };
}

/** Take up what was asked of a picture. */
export function loadView(view: DraftView, asked: ViewRequest): void {
  const { points } = asked;
  const placed = typeof points === "object" && points !== null && !Array.isArray(points) ? namedPoints(points) : {};
  const loaded: Points = { ...NO_POINTS, placed };
  batch(() => {
    view.timeline.value = begin(isEnough(loaded) ? skipRest(loaded) : loaded);
    if (asked.view) view.view.value = asked.view;
    view.focalLength.value = lensOf(asked, view.picture);
    view.facing.value = asked.limb_facing ?? {};
    if (typeof asked.clothing === "string") view.clothing.value = asked.clothing;
  });
}

/** As on 35 mm film, whichever way it was said; null if it was not. */
function lensOf({ focal_length_px, focal_length_35mm }: ViewRequest, { width, height }: Picture): number | null {
  if (focal_length_px == null) return focal_length_35mm ?? null;
  return (focal_length_px * FILM_DIAGONAL_MM) / Math.hypot(width, height);
}
