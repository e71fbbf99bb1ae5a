// What there is to know of a result, the most important first, each with what can be done about it.
import type { FitResult, Remark, ViewResult } from "../api/types";
import { person } from "../draft/draft";
import { heightInWords, inches } from "../draft/person";
import { decimal, listed, measured } from "../messages/figures";
import { messages } from "../messages";
import { viewTitles } from "../messages/viewNames";
import { plainName, wordFor } from "../messages/words";
import { remarked } from "../ui/answered";
import { contradictionOf } from "./quality";
import { isChief, measureLabel } from "./reading";

/** Correct what was said, take another picture, or say which way limbs slant. */
export type Deed = "adjust" | "another" | "limbs";

export interface Note {
  readonly code: string;
  readonly text: string;
  readonly isProblem: boolean;
  /** Of the picture it is of; null of all. */
  readonly number: number | null;
  /** Null where nobody can do anything. */
  readonly deed: Deed | null;
  readonly limbs: readonly string[];
}

/** Of limbs that may slant either way this page tells by itself. */
const OPEN_FACING = "ambiguous-limb-facing";

/** Only another picture mends these. */
const RETAKE: ReadonlySet<string> = new Set([
  "arms-against-trunk", "blurred", "camera-rolled", "camera-too-near", "child", "covered", "cut-off", "face-hidden", "nobody-found",
  "not-standing", "other-shape", "other-view", "person-too-small", "picture-too-small", "several-people", "squeezed", "too-bright", "too-dark",
]);
const TO_KNOW: ReadonlySet<string> = new Set(["body-outside-picture", "clip-cut", "lens-assumed", "points-proposed", "shading-not-used", "way-differs"]);

function deedOf(code: string): Deed | null {
  if (TO_KNOW.has(code)) return null;
  return RETAKE.has(code) ? "another" : "adjust";
}

/** In this order, and as the service tells them where they are alike. */
function rankOf({ code, isProblem, deed }: Note): number {
  if (isProblem) return 0;
  if (code === "height-assumed") return 1;
  return deed === null ? 5 : { adjust: 2, another: 3, limbs: 4 }[deed];
}

export function notesOf(result: FitResult): readonly Note[] {
  const contradiction = contradictionOf(result);
  const notes = [
    ...(contradiction === null ? [] : [noteOf(result.verdict, contradiction, null, { isProblem: true })]),
    ...result.views.flatMap((view, number) => ofView(view, number, result)),
    ...[...result.warnings, ...result.assumptions].map((remark) => ofRemark(remark, null, result)),
  ];
  // What is assumed of one picture is so of all.
  const told = notes.filter(({ text }, at) => notes.findIndex((other) => other.text === text) === at);
  return told.sort((a, b) => rankOf(a) - rankOf(b));
}

function ofView(view: ViewResult, number: number, result: FitResult): readonly Note[] {
  const explained = wordFor(messages.result.explained, view.outcome);
  const found = new Set(view.findings.map(({ code }) => code));
  const warnings = view.warnings.filter(({ code }) => code !== OPEN_FACING && !found.has(code));
  return [
    ...(explained === null ? [] : [noteOf(view.outcome, explained, number, { isProblem: true })]),
    ...[...view.findings, ...warnings, ...view.assumptions].map((remark) => ofRemark(remark, number, result)),
    ...ofLimbs(view, number),
  ];
}

function ofLimbs({ limb_facing }: ViewResult, number: number): readonly Note[] {
  const { points, result: words } = messages;
  const open = limb_facing.filter(({ ambiguous }) => ambiguous);
  if (open.length === 0) return [];
  const named = listed(open.map(({ limb, facing }) => words.slants[facing](wordFor(points.limbs, limb) ?? plainName(limb))));
  return [noteOf(OPEN_FACING, words.openFacing(named), number, { deed: "limbs", limbs: open.map(({ limb }) => limb) })];
}

function ofRemark(remark: Remark, number: number | null, result: FitResult): Note {
  const { assumed } = messages.frame;
  const view = result.views[number ?? 0]!;
  const words: Readonly<Record<string, () => string>> = {
    "lens-assumed": () => assumed.lens(measured(lensMm(view), "millimeter")),
    "height-assumed": () => assumed.height(heightInWords(result.height_m, person.value.units)),
    "points-proposed": () => assumed.points(remark.where.length),
    "measurements-withheld": () => messages.result.leftOut(listed(remark.where.filter(isChief).map(measureLabel))),
    // What was taken off, and how well the waist is known.
    "clothes-loose": () => lengthsIn(person.value.units, `${remark.reason} ${remark.remedy}`),
  };
  const text = words[remark.code]?.() ?? withTitles(remarked(remark), result.views);
  return noteOf(remark.code, text, number, { isProblem: remark.severity === "blocks" });
}

function noteOf(code: string, text: string, number: number | null, more: Partial<Note>): Note {
  return { code, text, number, isProblem: false, deed: deedOf(code), limbs: [], ...more };
}

/** A message of the service, which speaks of centimetres. */
function lengthsIn(units: typeof person.value.units, message: string): string {
  if (units === "metric") return message;
  return message.replace(/\b(\d+(?:\.\d+)?) cm\b/g, (_, cm: string) => `${decimal(inches(Number(cm)), 1)} in`);
}

/** A message of the service with its pictures as people call them: `views.1` is the side picture. */
function withTitles(message: string, views: FitResult["views"]): string {
  const titles = viewTitles(views);
  return message.replace(/\bviews\.(\d+)\b/g, (whole, number: string) => titles[Number(number)] ?? whole);
}

/** The focal length as on 35 mm film. */
export function lensMm({ image_camera: camera }: ViewResult): number {
  return (camera.focal_length_px * 43.27) / Math.hypot(camera.width, camera.height);
}
