// Figures as in the paper.
import type { NamedPose } from "../../api/types";
import { degrees as angle } from "../../messages/figures";
import { messages } from "../../messages";
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
  request: ({ pose, degrees }) => ({ kind: "figure", pose, degrees }),
  Options: ({ wishes: { pose, degrees }, onWish }) => (
    <>
      <PoseChoice pose={pose} onChoose={(pose) => onWish({ pose })} />
      <Slider label={messages.derived.figure.from} range={DEGREES} value={degrees} text={viewText(degrees)} onInput={(degrees) => onWish({ degrees })} />
    </>
  ),
  pictures: [{ file: "figure.png", alt: () => messages.derived.figure.pictured }],
  turns: { file: "body_reposed.glb", label: () => messages.derived.pose.turned },
};

/** How far the onlooker has walked round the body, to the right of the picture. */
function viewText(degrees: number): string {
  const { figure: words } = messages.derived;
  if (degrees === 0) return words.front;
  if (Math.abs(degrees) === 180) return words.behind;
  return degrees > 0 ? words.right(angle(degrees)) : words.left(angle(-degrees));
}
