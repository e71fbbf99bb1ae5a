// Other poses.
import type { NamedPose } from "../../api/types";
import { PoseChoice } from "../PoseChoice";
import type { Kind } from "./kind";

interface PoseWishes {
  readonly pose: NamedPose;
}

export const FIRST_POSE: PoseWishes = { pose: "standing" };

export const pose: Kind<PoseWishes> = {
  label: "Other pose",
  help: "The same body held otherwise, as a mesh.",
  request: ({ pose }) => ({ kind: "pose", pose }),
  Options: ({ wishes: { pose }, onWish }) => <PoseChoice pose={pose} onChoose={(pose) => onWish({ pose })} />,
  pictures: [{ file: "pose.png", alt: "Other pose of the body" }],
  turns: { file: "body_reposed.glb", label: "The body in this pose" },
};
