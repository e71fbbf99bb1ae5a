// What can be made of a finished fit, as a person reads it.
import type { DerivationKind, DerivationRequest, NamedPose } from "../api/types";

/** What is chosen of every kind, whichever is shown. */
export interface Wishes {
  readonly factor: number;
  readonly pose: NamedPose;
}

export const FIRST_WISHES: Wishes = { factor: 2, pose: "standing" };
export const FACTORS = { least: 0, most: 5, step: 0.25 } as const;

export const POSES: readonly { value: NamedPose; label: string }[] = [
  { value: "standing", label: "Standing" },
  { value: "relaxed", label: "Relaxed" },
  { value: "walking", label: "Walking" },
  { value: "sitting", label: "Sitting" },
  { value: "arms_raised", label: "Arms raised" },
  { value: "a_pose", label: "A pose" },
  { value: "t_pose", label: "T pose" },
  { value: "rest", label: "The model’s own" },
];

interface Kind {
  readonly label: string;
  readonly help: string;
  readonly request: (wishes: Wishes) => DerivationRequest;
  /** The picture that shows what came out, if any. */
  readonly picture: string | null;
}

/** Those this page can ask for; a service may know more. */
export const KINDS: Readonly<Partial<Record<DerivationKind, Kind>>> = {
  report: {
    label: "Report",
    help: "One page to read and to print: pictures, measurements, light.",
    request: () => ({ kind: "report" }),
    picture: null,
  },
  pose: {
    label: "Other pose",
    help: "The same body held otherwise, as a mesh.",
    request: ({ pose }) => ({ kind: "pose", pose }),
    picture: "pose.png",
  },
  caricature: {
    label: "Caricature",
    help: "What is most unusual of this body, exaggerated; as tall as it is.",
    request: ({ factor }) => ({ kind: "caricature", factor }),
    picture: "caricature.png",
  },
};

export function kindLabel(kind: string): string {
  return KINDS[kind as DerivationKind]?.label ?? kind.charAt(0).toUpperCase() + kind.slice(1);
}
