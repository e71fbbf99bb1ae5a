// From where light falls, in words.
import { degrees } from "../messages/figures";
import { messages } from "../messages";

/** From which side light falls, of an angle that is positive to the right. */
export function fromSide(azimuth: number): string {
  const { light: words } = messages.panel;
  const angle = degrees(Math.abs(azimuth));
  return azimuth > 0 ? words.fromRight(angle) : words.fromLeft(angle);
}

/** Whether it falls from above or below. */
export function fromHeight(elevation: number): string {
  const { light: words } = messages.panel;
  const angle = degrees(Math.abs(elevation));
  return elevation > 0 ? words.fromAbove(angle) : words.fromBelow(angle);
}
