// Caricatures.
import { typed } from "../../messages/figures";
import { messages } from "../../messages";
import { Slider } from "../Slider";
import type { Kind } from "./kind";

const FACTORS = { least: 0, most: 5, step: 0.25 } as const;

interface CaricatureWishes {
  readonly factor: number;
}

export const FIRST_CARICATURE: CaricatureWishes = { factor: 2 };

export const caricature: Kind<CaricatureWishes> = {
  request: ({ factor }) => ({ kind: "caricature", factor, exaggerated: "looks" }),
  Options: ({ wishes: { factor }, onWish }) => (
    <Slider
      label={messages.derived.caricature.strength}
      range={FACTORS}
      value={factor}
      text={messages.derived.caricature.times(typed(factor, 2))}
      onInput={(factor) => onWish({ factor })}
    />
  ),
  pictures: [{ file: "caricature.png", label: () => messages.derived.caricature.beside, alt: () => messages.derived.caricature.pictured }],
  smaller: (largest) => ({
    request: { kind: "caricature", factor: largest, exaggerated: "looks" },
    refusal: messages.derived.caricature.refused(typed(largest, 2)),
    make: messages.derived.caricature.smaller(typed(largest, 2)),
  }),
  turns: { file: "body_caricature.glb", label: () => messages.derived.caricature.turned, first: true },
};
