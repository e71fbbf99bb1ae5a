// Other poses.
import type { NamedPose } from "../../api/types";
import { messages } from "../../messages";
import { PoseChoice } from "../PoseChoice";
import type { Kind } from "./kind";

interface PoseWishes {
  readonly pose: NamedPose;
}

export const FIRST_POSE: PoseWishes = { pose: "standing" };

export const pose: Kind<PoseWishes> = {
  request: ({ pose }) => ({ kind: "pose", pose }),
  Options: ({ wishes: { pose }, onWish }) => <PoseChoice pose={pose} onChoose={(pose) => onWish({ pose })} />,
  pictures: [{ file: "pose.png", label: () => messages.derived.pose.sides, alt: () => messages.derived.pose.pictured }],
  turns: { file: "body_reposed.glb", label: () => messages.derived.pose.turned, first: true },
};
