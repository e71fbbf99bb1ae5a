// Answers of /v1/points, made by hand.
import type { PointsProposal } from "../../../service/page/src/api/types";

type Proposed = PointsProposal["points"];

function point(x: number, y: number, visibility: 1 | 2 = 2): NonNullable<Proposed["nose"]> {
  return { x, y, visibility, source: "proposal", confidence: visibility === 2 ? 0.95 : 0.3 };
}

/** Someone who faces the camera, an ankle hidden. */
export const FOUND: PointsProposal = {
  image_size: { width: 720, height: 960 },
  persons: [[170, 60, 560, 850]],
  person: 0,
  points: {
    nose: point(334, 123),
    left_shoulder: point(440, 220),
    right_shoulder: point(250, 225),
    left_wrist: point(540, 460),
    right_wrist: point(230, 410),
    left_hip: point(390, 466),
    right_hip: point(300, 462),
    left_knee: point(408, 675),
    right_knee: point(295, 658),
    left_ankle: point(398, 822, 1),
    right_ankle: point(296, 830),
  } as Proposed,
  doubtful: ["left_ankle", "right_wrist"],
  mask: null,
  usable: true,
  findings: [],
  not_checked: [],
  seen_from: null,
  lean_deg: null,
  distance_m: null,
  clothing: null,
  assumptions: [],
  warnings: [],
};

export const NOBODY_FOUND: PointsProposal = {
  ...FOUND,
  persons: [],
  person: null,
  points: {} as Proposed,
  doubtful: [],
};

/** The same points, of one among several. */
export function proposalOf(boxes: readonly (readonly [number, number, number, number])[], person = 0): PointsProposal {
  return { ...FOUND, persons: boxes.map((box) => [...box]), person };
}
