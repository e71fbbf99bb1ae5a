// All limbs that can be turned, for whoever clicks none on the body.
import type { Facing, ViewResult } from "../api/types";
import { capitalised } from "../messages/figures";
import { messages } from "../messages";
import { TURNED_LIMBS, facingsOf } from "./flips";
import type { Flips, TurnedLimb } from "./flips";

interface Props {
  readonly view: ViewResult;
  /** Of one of several pictures its name. */
  readonly title: string | null;
  readonly flips: Flips;
  readonly pointedAt: TurnedLimb | null;
  readonly onPoint: (limb: TurnedLimb | null) => void;
  readonly onFlip: (limb: TurnedLimb) => void;
}

const LIST = "limbs";

export function LimbList({ view, title, flips, pointedAt, onPoint, onFlip }: Props) {
  const { frame, limbs: words, points } = messages;
  const found = facingsOf(view);
  const open = new Set(view.limb_facing.filter(({ ambiguous }) => ambiguous).map(({ limb }) => limb));
  const isKnown = (limb: TurnedLimb): limb is TurnedLimb => found[limb] !== undefined;
  const says = (limb: TurnedLimb, facing: Facing) => {
    if (flips[limb]) return words.now(words.facings[flips[limb]]);
    return open.has(limb) ? `${words.facings[facing]}, ${words.isOpen}` : words.facings[facing];
  };
  return (
    <details class="section fold-section" id={LIST}>
      <summary>
        <h2>{title ? frame.ofField(title, words.title) : words.title}</h2>
      </summary>
      <p class="fine">{words.help}</p>
      <ul class="limb-list">
        {TURNED_LIMBS.filter(isKnown).map((limb) => (
          <li key={limb}>
            <button
              id={buttonOf(limb)}
              class={`limb ${pointedAt === limb ? "is-pointed" : ""}`}
              type="button"
              aria-pressed={flips[limb] !== undefined}
              onClick={() => onFlip(limb)}
              onPointerEnter={() => onPoint(limb)}
              onPointerLeave={() => onPoint(null)}
              onFocus={() => onPoint(limb)}
              onBlur={() => onPoint(null)}
            >
              {capitalised(points.limbs[limb])} <small>{says(limb, found[limb]!)}</small>
            </button>
          </li>
        ))}
      </ul>
    </details>
  );
}

export function openList(): void {
  (document.getElementById(LIST) as HTMLDetailsElement).open = true;
}

/** Open the list where a limb is. */
export function goToLimb(limb: TurnedLimb): void {
  openList();
  const button = document.getElementById(buttonOf(limb));
  button?.scrollIntoView({ block: "center" });
  button?.focus({ preventScroll: true });
}

function buttonOf(limb: TurnedLimb): string {
  return `limb-${limb}`;
}
