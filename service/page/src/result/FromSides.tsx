// From where the body is looked at.
import { messages } from "../messages";
import type { Side } from "../viewer/Turntable";

const SIDES: readonly Side[] = ["front", "side", "back"];

export function FromSides({ onLook }: { onLook: (from: { readonly side: Side }) => void }) {
  const { look } = messages;
  return (
    <div class="row from-sides" role="group" aria-label={look.from}>
      {SIDES.map((side) => (
        <button key={side} class="button is-small" type="button" aria-label={look.sides[side]} onClick={() => onLook({ side })}>
          {look.sideNames[side]}
        </button>
      ))}
    </div>
  );
}
