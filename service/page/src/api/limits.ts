// The limits that the API document states, so that they are written down once.
import { "x-limits" as stated } from "../../../../api_schemas/openapi.json";
import type { TextureSize } from "./types";

export const LIMITS = {
  limbPoints: stated.points.least_limb_points,
  trunkPoints: stated.points.least_trunk_points,
  clearBreadth: stated.points.clear_breadth,
  heightM: [stated.height_m.least, stated.height_m.most],
  textureSizes: stated.texture_sizes as readonly TextureSize[],
  leastSidePx: stated.picture.least_side,
  largestAspectRatio: stated.picture.largest_aspect_ratio,
  otherFits: stated.most_other_fits,
} as const;
