// Asks, where left and right look swapped, and mends it by one click.
import { change, points, seenFromBehind } from "../draft/draft";
import { messages } from "../messages";
import { sideDoubt, swapped } from "../points/sides";

export function SideNote() {
  const { sides } = messages.panel;
  const doubt = sideDoubt(points.value);
  if (!doubt || (doubt.kind === "behind" && seenFromBehind.value)) return null;
  return (
    <div class="note" role="status">
      <p>{sides.questions[doubt.kind]}</p>
      <div class="row">
        <button class="button is-small" type="button" onClick={() => change(swapped(points.value, doubt.names))}>
          {sides.mends[doubt.kind]}
        </button>
        {doubt.kind === "behind" && (
          <button class="button is-small" type="button" onClick={() => (seenFromBehind.value = true)}>
            {sides.seesBack}
          </button>
        )}
      </div>
    </div>
  );
}
