// The first sample's body from all sides, as a strip of views drawn in advance (tests/evaluation/turning_body.py):
// it is there before the viewer is loaded. Whoever wants little motion sees it stand.
import { useSignal } from "@preact/signals";
import { messages } from "../messages/language";

export function Turning() {
  const { turning } = messages.value.start;
  const isHeld = useSignal(false);
  return (
    <figure class="turning">
      <div class="turning-frame" role="img" aria-label={turning.label}>
        <div class={`turning-strip ${isHeld.value ? "is-held" : ""}`} />
      </div>
      <figcaption class="fine">{turning.caption}</figcaption>
      <button class="button is-small turning-switch" type="button" onClick={() => (isHeld.value = !isHeld.value)}>
        {isHeld.value ? turning.turn : turning.hold}
      </button>
    </figure>
  );
}
