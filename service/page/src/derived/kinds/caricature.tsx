// Caricatures.
import { Slider } from "../Slider";
import type { Kind } from "./kind";

const FACTORS = { least: 0, most: 5, step: 0.25 } as const;

interface CaricatureWishes {
  readonly factor: number;
}

export const FIRST_CARICATURE: CaricatureWishes = { factor: 2 };

export const caricature: Kind<CaricatureWishes> = {
  label: "Caricature",
  help: "What is most unusual of this body, exaggerated; as tall as it is.",
  request: ({ factor }) => ({ kind: "caricature", factor }),
  Options: ({ wishes: { factor }, onWish }) => (
    <Slider label="Times" range={FACTORS} value={factor} text={String(factor)} onInput={(factor) => onWish({ factor })} />
  ),
  pictures: [{ file: "caricature.png", alt: "Caricature of the body" }],
  turns: { file: "body_caricature.glb", label: "The caricature" },
};
