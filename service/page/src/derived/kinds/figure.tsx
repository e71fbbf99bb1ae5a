// Figures as in the paper.
import type { NamedPose } from "../../api/types";
import { PoseChoice } from "../PoseChoice";
import { Slider } from "../Slider";
import type { Kind } from "./kind";

const DEGREES = { least: -180, most: 180, step: 15 } as const;

interface FigureWishes {
  readonly pose: NamedPose;
  readonly degrees: number;
}

export const FIRST_FIGURE: FigureWishes = { pose: "standing", degrees: 0 };

export const figure: Kind<FigureWishes> = {
  label: "Figure",
  help: "Picture, overlay, body and a new pose side by side, as in the paper’s Fig. 10.",
  request: ({ pose, degrees }) => ({ kind: "figure", pose, degrees }),
  Options: ({ wishes: { pose, degrees }, onWish }) => (
    <>
      <PoseChoice pose={pose} onChoose={(pose) => onWish({ pose })} />
      <Slider label="Seen from" range={DEGREES} value={degrees} text={viewText(degrees)} onInput={(degrees) => onWish({ degrees })} />
    </>
  ),
  pictures: [{ file: "figure.png", alt: "Picture, overlay, body and new pose" }],
};

/** How far the onlooker has walked round the body, to the right of the picture. */
function viewText(degrees: number): string {
  if (degrees === 0) return "in front";
  if (Math.abs(degrees) === 180) return "behind";
  return `${Math.abs(degrees)}° ${degrees > 0 ? "right" : "left"}`;
}
