// Asks about proposed points one by one; nothing waits for the answers.
import { useEffect, useRef } from "preact/hooks";
import { change, picture, points, selected } from "../draft/draft";
import { pointOf, sideOf } from "../points/catalogue";
import type { PointName } from "../points/catalogue";
import { ask, confirm, nextDoubt, setHidden, skip } from "../points/placed";
import type { Points } from "../points/placed";
import { drawMagnified } from "../stage/magnified";
import { announce } from "../ui/announce";

const CLOSE_UP_PX = 116;
/** The close-up shows this share of the picture's longer side. */
const SHOWN_SHARE = 0.16;

export function questionOf(name: PointName): string {
  const label = pointOf(name).label.toLowerCase();
  return label.endsWith("toes") ? `Are these the ${label}?` : `Is this the ${label}?`;
}

export function DoubtQuestion({ name }: { name: PointName }) {
  const left = points.value.doubts.length;
  return (
    <>
      <p class="next-kicker">{left === 1 ? "Please look" : `Please look: ${left} to go`}</p>
      <p class={`next-name is-${sideOf(name)}`}>{questionOf(name)}</p>
      <p class="next-help">{pointOf(name).help}</p>
      <DoubtAnswers name={name} />
      <p class="fine">You need not answer: the fit trusts proposals less than clicks.</p>
    </>
  );
}

export function DoubtAnswers({ name }: { name: PointName }) {
  return (
    <div class="row" role="group" aria-label={questionOf(name)}>
      <button class="button is-small" type="button" onClick={() => answer(confirm(points.value, name))}>
        Yes
      </button>
      <button class="button is-small" type="button" onClick={() => move(name)}>
        Move it
      </button>
      <button class="button is-small" type="button" onClick={() => answer(setHidden(points.value, name, true))}>
        It is hidden
      </button>
      <button class="button is-small" type="button" onClick={() => answer(skip(points.value, name))}>
        Leave out
      </button>
    </div>
  );
}

/** What lies where the point is proposed. */
export function DoubtCloseUp({ name }: { name: PointName }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const where = points.value.placed[name];
  const shown = picture.value;
  useEffect(() => {
    if (!where || !shown) return;
    const scale = CLOSE_UP_PX / (SHOWN_SHARE * Math.max(shown.width, shown.height));
    drawMagnified(canvas.current!, { picture: shown, centre: where, scale, sidePx: CLOSE_UP_PX, places: [] });
  }, [where, shown]);
  return <canvas class="doubt-close-up" ref={canvas} aria-hidden="true" />;
}

function answer(next: Points): void {
  change(next);
  selected.value = null;
  const following = nextDoubt(next);
  announce(following ? questionOf(following) : "No more questions about points.");
  // Its buttons are gone: keys go on at the picture.
  if (!following) document.querySelector<HTMLElement>(".stage")?.focus({ preventScroll: true });
}

/** The next click places it; dragging it and the arrow keys do as well. */
function move(name: PointName): void {
  change(ask(points.value, name));
  selected.value = name;
  document.querySelector<HTMLElement>(".stage")?.focus({ preventScroll: true });
  announce(`Click where the ${pointOf(name).label.toLowerCase()} is, or move it by the arrow keys.`);
}
