// The limbs that are seen turned the other way, in each picture of a fit, and the one pointed at.
import { useState } from "preact/hooks";
import type { ViewResult } from "../api/types";
import { messages } from "../messages";
import { announce } from "../ui/announce";
import { NO_FLIPS, areAllEmpty, facingsOf, flipped } from "./flips";
import type { Flips, FlipsOfViews, TurnedLimb } from "./flips";
import { inWords } from "./words";

export interface Turning {
  /** Of the picture that is shown. */
  readonly flips: Flips;
  readonly all: FlipsOfViews;
  readonly pointedAt: TurnedLimb | null;
  readonly point: (limb: TurnedLimb | null) => void;
  readonly flip: (limb: TurnedLimb) => void;
  readonly takeBack: () => void;
}

/** `number` is that of the picture that is shown. */
export function useFlips(views: readonly ViewResult[], number: number): Turning {
  const [all, setAll] = useState<FlipsOfViews>({});
  const [pointedAt, point] = useState<TurnedLimb | null>(null);
  const change = (next: FlipsOfViews) => {
    const { limbs: words } = messages;
    setAll(next);
    announce(areAllEmpty(next) ? words.takenBack : words.preview(inWords(next, views)));
  };
  const flips = all[number] ?? NO_FLIPS;
  return {
    flips,
    all,
    pointedAt,
    point,
    flip: (limb) => {
      const view = views[number];
      const found = view && facingsOf(view)[limb];
      if (found) change({ ...all, [number]: flipped(flips, limb, found) });
    },
    takeBack: () => change({}),
  };
}
