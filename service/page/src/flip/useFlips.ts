// The limbs of a result that are seen turned the other way, and the one pointed at.
import { useState } from "preact/hooks";
import type { FitResult } from "../api/types";
import { messages } from "../messages/language";
import { announce } from "../ui/announce";
import { NO_FLIPS, facingsOf, flipped, isEmpty } from "./flips";
import type { Flips, TurnedLimb } from "./flips";
import { inWords } from "./words";

export interface Turning {
  readonly flips: Flips;
  readonly pointedAt: TurnedLimb | null;
  readonly point: (limb: TurnedLimb | null) => void;
  readonly flip: (limb: TurnedLimb) => void;
  readonly takeBack: () => void;
}

export function useFlips(result: FitResult | null): Turning {
  const [flips, setFlips] = useState<Flips>(NO_FLIPS);
  const [pointedAt, point] = useState<TurnedLimb | null>(null);
  const change = (next: Flips) => {
    const { limbs: words } = messages.value;
    setFlips(next);
    announce(isEmpty(next) ? words.takenBack : words.preview(inWords(next)));
  };
  return {
    flips,
    pointedAt,
    point,
    flip: (limb) => {
      const found = result && facingsOf(result)[limb];
      if (found) change(flipped(flips, limb, found));
    },
    takeBack: () => change(NO_FLIPS),
  };
}
