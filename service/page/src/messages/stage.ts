// The picture that is clicked on.
import { plural } from "./figures";

export const stage = {
  label: (state: string) => `Picture to click on. ${state}`,
  next: (point: string) => `Next: ${point}.`,
  allPlaced: "All points are placed.",
  allProposed: "All points are proposed.",
  placed: (point: string, then: string) => `${point} placed. ${then}`,
  maskBorder: "The border of the mask",
  takeBack: "Take the last change back",
  zoomOut: "Zoom out",
  whole: "Show the whole picture",
  zoomIn: "Zoom in",
  tools: "Picture",
  full: "Fill the screen",
  leaveFull: "Leave the full screen",
  hidden: (point: string) => `Hidden behind something: ${point}`,
  skip: (point: string) => `Skip: ${point}`,
  enough: "Enough points",
  keys:
    "Arrow keys move the selected point, or the crosshair when none is selected; Shift moves ten pixels. Enter places the next point at the crosshair, Escape selects nothing, S skips, H marks as hidden, Delete removes, plus and minus zoom, 0 shows the whole picture, Control Z undoes.",
  asked: (point: string) => `${point}?`,
  proposing: "Looking for the person …",
  nobody: "Nobody was found in this picture.",
  several: (count: number) => `${count} people were found. Choose the one you mean.`,
  severalFound: (count: number) => `${count} people were found.`,
  proposed: (count: number) => plural(count, { one: "One point is proposed.", other: `${count} points are proposed.` }),
  lookAt: (points: string) => `Look at these: ${points}.`,
} as const;
