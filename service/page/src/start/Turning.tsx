// The first sample's body from all sides, as a strip of views drawn in advance (tests/illustrations/turning_body.py):
// it is there before the viewer is loaded. A tap holds it; whoever wants little motion sees it stand.
import { useSignal } from "@preact/signals";
import { messages } from "../messages";

export function Turning() {
  const { turning } = messages.start;
  const isHeld = useSignal(false);
  return (
    <figure class="turning">
      <button class="turning-switch" type="button" aria-label={turning.label} aria-pressed={isHeld.value} title={turning.hold} onClick={() => (isHeld.value = !isHeld.value)}>
        <span class="turning-frame">
          <span class={`turning-strip ${isHeld.value ? "is-held" : ""}`} />
        </span>
      </button>
      <figcaption class="fine">{turning.caption}</figcaption>
    </figure>
  );
}
