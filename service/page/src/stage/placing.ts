// What a click, a drag or a key does to the points.
import { change, points, selected, upcoming } from "../draft/draft";
import { choosePersonAt } from "../draft/proposing";
import { messages } from "../messages";
import type { PointName } from "../points/catalogue";
import { place } from "../points/placed";
import { announce } from "../ui/announce";
import { toPicture, toStage } from "./view";
import type { Size, Spot, View } from "./view";

const SELECT_PX = 12;

/** Place the next point; when there is none to place, select one, or another person. */
export function tap(at: Spot, view: View, picture: Size): void {
  const name = upcoming.value;
  const { x, y } = toPicture(view, at);
  if (name === null) {
    selected.value = nearest(view, at, SELECT_PX);
    if (selected.value === null) choosePersonAt(x, y);
    return;
  }
  if (x < 0 || y < 0 || x > picture.width || y > picture.height) return;
  placeNext(name, x, y);
  selected.value = name;
}

export function placeNext(name: PointName, x: number, y: number): void {
  change(place(points.value, name, x, y));
  const next = upcoming.value;
  const { points: words, stage } = messages;
  announce(stage.placed(words.labels[name], next ? stage.next(words.labels[next]) : stage.allPlaced));
}

/** The placed point that is drawn nearest to a spot of the stage, within a distance. */
export function nearest(view: View, at: Spot, withinPx: number): PointName | null {
  let best: PointName | null = null;
  let least = withinPx;
  for (const [name, where] of Object.entries(points.value.placed)) {
    const spot = toStage(view, where);
    const distance = Math.hypot(spot.x - at.x, spot.y - at.y);
    if (distance <= least) [best, least] = [name as PointName, distance];
  }
  return best;
}
