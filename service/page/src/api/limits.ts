// The limits and names that the API document states, so that they are written down once.
import { "x-limits" as stated } from "../../../../api_schemas/openapi.json";
import type { PointName, TextureSize } from "./types";

export const LIMITS = {
  limbPoints: stated.points.least_limb_points,
  trunkPoints: stated.points.least_trunk_points,
  heightM: [stated.height_m.least, stated.height_m.most],
  textureSizes: stated.texture_sizes as readonly TextureSize[],
} as const;

/** COCO's seventeen points come first. */
export const POINTS = {
  names: stated.points.names as readonly PointName[],
  limbs: stated.points.limb_names as readonly PointName[],
  trunk: stated.points.trunk_names as readonly PointName[],
} as const;

/** What most people ask for, and all measurements under headings. */
export const MEASUREMENTS = { chief: stated.measurements.chief, groups: stated.measurements.groups } as const;
