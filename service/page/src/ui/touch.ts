// Whether the device is held in the hand: it has a camera, and nothing is dragged onto its pages.
export const isTouched = matchMedia("(pointer: coarse)").matches;
