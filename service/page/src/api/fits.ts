// The service's fits, of one picture, and its scans, of several, as one type: a fit of one to six pictures.
import type { components } from "./schema";
import type { FitOptions, FitResult, Job, Scan, ScanOptions, ScanResult, StageMeasurement, ViewKind } from "./types";

type Schemas = components["schemas"];

/** What the service calls it, and so by which path it is reached. */
export type FitKind = "fit" | "scan";

export interface FitRef {
  readonly kind: FitKind;
  readonly id: string;
}

/** Paths of what was sent for one picture. */
type SentPicture = Schemas["ScanViewLinks"];

export interface Fit extends Omit<Scan, "links"> {
  readonly kind: FitKind;
  readonly links: Omit<Scan["links"], "views">;
  readonly pictures: readonly SentPicture[];
}

/** The person in one of the pictures. */
export interface FittedView extends Omit<Schemas["ScannedView"], "view" | "stance"> {
  /** From where the picture was said to show the person. */
  readonly view: ViewKind | null;
  readonly limb_facing: FitResult["limb_facing"];
}

/** One body, and how it stands in each picture. Assumptions and warnings are of the whole; those of a picture are with it. */
export interface Result
  extends Pick<ScanResult, "gender" | "cues" | "verdict" | "outcome_explanation" | "measurements" | "assumptions" | "warnings" | "artifacts"> {
  readonly views: readonly FittedView[];
  /** How well several pictures agree; null of one. */
  readonly agreement: number | null;
  /** The measurements by silhouette and edges alone; null where shading was not used. */
  readonly outlined: readonly StageMeasurement[] | null;
  readonly energies: Readonly<Record<string, number>>;
  readonly evaluations: number;
  readonly stage_seconds: Readonly<Record<string, number>>;
}

/** What was asked for: of the person and the whole, and of each picture. */
export interface Asked extends Omit<ScanOptions, "views"> {
  readonly views: readonly AskedView[];
}

export type AskedView = Pick<FitOptions, (typeof OF_A_PICTURE)[number]> & { readonly view?: ViewKind };

const OF_A_PICTURE = [
  "points", "format", "complete_points", "limb_facing", "slant_hints", "focal_length_px", "focal_length_35mm",
  "clothing", "segmentation", "light",
] as const;

export function pathOf({ kind, id }: FitRef): string {
  return `/v1/${kind}s/${id}`;
}

export function fitOfJob({ links: { image, mask, ...links }, ...job }: Job): Fit {
  return { ...job, kind: "fit", view: null, links, pictures: [mask ? { image, mask } : { image }] };
}

export function fitOfScan({ links: { views, ...links }, ...scan }: Scan): Fit {
  return { ...scan, kind: "scan", links, pictures: views };
}

/** The name of a file that there is of each picture: `overlay_1.png` of the second of several. */
export function nameOfView({ kind }: Pick<Fit, "kind">, name: string, number: number): string {
  return kind === "scan" ? name.replace(".", `_${number}.`) : name;
}

/** Earlier versions told no verdict of a fit. */
export function resultOfFit({ assumptions, warnings, verdict = "plausible", ...found }: FitResult): Result {
  const { findings = [] } = found as Partial<Pick<FittedView, "findings">>;
  const view = { ...found, verdict, number: 0, view: null, findings, assumptions, warnings };
  return { ...found, verdict, views: [view], agreement: null, outlined: outlined(found), assumptions: [], warnings: [] };
}

/** Earlier versions told no stages, energies and times of a scan, nor how limbs slant. */
export function resultOfScan(found: ScanResult): Result {
  const { stages = [], energies = {}, evaluations = 0, stage_seconds = {} } = found as Partial<FitResult>;
  const views = found.views.map((view) => ({ limb_facing: [], ...view }));
  return { ...found, views, outlined: outlined({ cues: found.cues, stages }), energies, evaluations, stage_seconds };
}

function outlined({ cues, stages }: Pick<FitResult, "cues" | "stages">): readonly StageMeasurement[] | null {
  if (cues !== "SES") return null;
  return stages.find((stage) => stage.name === "SE")?.measurements ?? null;
}

export function askedOfFit(options: FitOptions): Asked {
  const isOfPicture = (name: string) => (OF_A_PICTURE as readonly string[]).includes(name);
  const some = (isWanted: (name: string) => boolean) => Object.fromEntries(Object.entries(options).filter(([name]) => isWanted(name)));
  const whole = some((name) => !isOfPicture(name)) as Omit<Asked, "views">;
  return { ...whole, views: [some(isOfPicture) as unknown as AskedView] };
}

/** As of a fit of that picture alone. */
export function askedOfView({ views, ...whole }: Asked, number: number): FitOptions {
  const { view: _, ...of } = views[number]!;
  return { ...whole, ...of };
}
