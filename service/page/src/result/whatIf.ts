// The body with another weight or waist: the person's own, changed as the most probable bodies of such people differ.
import { estimateBody, estimateMesh } from "../api/calls";
import type { BodyRequest, FitResult, Measurement } from "../api/types";
import { readGlb } from "../viewer/glb";
import type { GlbBody } from "../viewer/glb";

/** What can be asked for otherwise, and what else follows it. */
export const CHANGED = ["weight", "waist_girth_smallest"] as const;
export const FOLLOWING = ["chest_girth", "hip_girth"] as const;

/** By how much, in the measurement's unit; nothing is as it was measured. */
export type Change = Readonly<Partial<Record<(typeof CHANGED)[number], number>>>;

export interface Changed {
  readonly body: GlbBody;
  readonly measurements: readonly Measurement[];
}

/** What keeps the person's build while weight or waist change. */
const BUILD = ["chest_girth", "waist_girth_smallest", "hip_girth", "thigh_girth", "upper_arm_girth", "neck_girth", "calf_girth", "inseam", "arm_length", "back_shoulder_width"];
/** A change of 5 kg moves girths by 2 to 3 cm: held so loosely, they do. */
const HELD_WITHIN_CM = 4;

/** Such a person with these measurements changed; `share` is 0 for as they were measured. */
export function bodyRequest({ gender, height_m, measurements }: Pick<FitResult, "gender" | "height_m" | "measurements">, change: Change, share = 1): BodyRequest {
  const known: NonNullable<BodyRequest["measurements"]> = {};
  for (const { name, value } of measurements) {
    const by = change[name as keyof Change];
    if (by !== undefined) known[name] = value + share * by;
    else if (BUILD.includes(name)) known[name] = { value, standard_error: HELD_WITHIN_CM };
  }
  return { gender, height_m, measurements: known };
}

/** The upright body and the measurements, with the difference between two estimates: without a change they are as they were. */
export async function changed(result: FitResult, upright: GlbBody, change: Change, leaving: AbortSignal): Promise<Changed> {
  const [to, from] = [bodyRequest(result, change), bodyRequest(result, change, 0)];
  const [mesh, before, after, known] = await Promise.all([
    estimateMesh(to, leaving), estimateMesh(from, leaving), estimateBody(to, leaving), estimateBody(from, leaving),
  ]);
  const [other, own] = [readGlb(mesh), readGlb(before)];
  const by = (name: string) => valueOf(after.measurements, name) - valueOf(known.measurements, name);
  return {
    body: { ...upright, positions: upright.positions.map((place, i) => place + other.positions[i]! - own.positions[i]!), normals: other.normals },
    measurements: result.measurements.map((each) => ({ ...each, value: each.value + by(each.name), standard_error: null })),
  };
}

function valueOf(measurements: readonly Pick<Measurement, "name" | "value">[], name: string): number {
  return measurements.find((each) => each.name === name)?.value ?? 0;
}
