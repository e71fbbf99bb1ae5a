// Caricatures.
import { typed } from "../../messages/figures";
import { messages } from "../../messages";
import { Slider } from "../../ui/Slider";
import type { Kind } from "./kind";

const FACTORS = { least: 0, most: 5, step: 0.25 } as const;
const words = messages.products.caricature;

interface CaricatureWishes {
  readonly factor: number;
}

export const FIRST_CARICATURE: CaricatureWishes = { factor: 2 };

export const caricature: Kind<CaricatureWishes> = {
  request: ({ factor }) => ({ kind: "caricature", factor }),
  Options: ({ wishes: { factor }, onWish }) => (
    <Slider label={words.strength} range={FACTORS} value={factor} text={words.times(typed(factor, 2))} onInput={(factor) => onWish({ factor })} />
  ),
  body: { file: "body_caricature.glb", label: words.turned },
};
