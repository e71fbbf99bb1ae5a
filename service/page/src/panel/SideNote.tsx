// Asks, where left and right look swapped, and mends it by one click.
import { change, points, seenFromBehind } from "../draft/draft";
import { sideDoubt, swapped } from "../points/sides";
import type { SideDoubt } from "../points/sides";

const QUESTIONS: Readonly<Record<SideDoubt["kind"], string>> = {
  behind: "By these points this person turns their back to you. If they face you, left and right are swapped: left is the person’s own left.",
  facing: "You see the face, but left and right are as if you saw the back: left is the person’s own left.",
  hips: "Shoulders and hips say opposite sides: the hips may be swapped.",
  arms: "Both arms cross to the other side: left and right elbow may be swapped.",
  legs: "Both legs cross to the other side: left and right knee may be swapped.",
};
const MENDS: Readonly<Record<SideDoubt["kind"], string>> = {
  behind: "They face me: swap",
  facing: "Swap left and right",
  hips: "Swap the hips and legs",
  arms: "Swap the arms",
  legs: "Swap the legs",
};

export function SideNote() {
  const doubt = sideDoubt(points.value);
  if (!doubt || (doubt.kind === "behind" && seenFromBehind.value)) return null;
  return (
    <div class="note" role="status">
      <p>{QUESTIONS[doubt.kind]}</p>
      <div class="row">
        <button class="button is-small" type="button" onClick={() => change(swapped(points.value, doubt.names))}>
          {MENDS[doubt.kind]}
        </button>
        {doubt.kind === "behind" && (
          <button class="button is-small" type="button" onClick={() => (seenFromBehind.value = true)}>
            I see their back
          </button>
        )}
      </div>
    </div>
  );
}
