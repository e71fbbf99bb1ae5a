// Asks about proposed points one by one; nothing waits for the answers.
import { useEffect, useRef } from "preact/hooks";
import { change, current, points, selected } from "../draft/draft";
import { messages } from "../messages";
import { sideOf } from "../points/catalogue";
import type { PointName } from "../points/catalogue";
import { ask, confirm, nextDoubt, setHidden, skip } from "../points/placed";
import type { Points } from "../points/placed";
import { drawMagnified } from "../stage/magnified";
import { announce } from "../ui/announce";

const CLOSE_UP_PX = 116;
/** The close-up shows this share of the picture's longer side. */
const SHOWN_SHARE = 0.16;

export function questionOf(name: PointName): string {
  return messages.points.question[name];
}

export function DoubtQuestion({ name }: { name: PointName }) {
  const { panel, points: words } = messages;
  return (
    <>
      <p class="next-kicker">{panel.doubt.look(points.value.doubts.length)}</p>
      <p class={`next-name is-${sideOf(name)}`}>{questionOf(name)}</p>
      <p class="next-help">{words.helps[name]}</p>
      <DoubtAnswers name={name} />
      <p class="fine">{panel.doubt.optional}</p>
    </>
  );
}

export function DoubtAnswers({ name }: { name: PointName }) {
  const { doubt } = messages.panel;
  return (
    <div class="row" role="group" aria-label={questionOf(name)}>
      <button class="button is-small" type="button" onClick={() => answer(confirm(points.value, name))}>
        {doubt.yes}
      </button>
      <button class="button is-small" type="button" onClick={() => move(name)}>
        {doubt.move}
      </button>
      <button class="button is-small" type="button" onClick={() => answer(setHidden(points.value, name, true))}>
        {doubt.hidden}
      </button>
      <button class="button is-small" type="button" onClick={() => answer(skip(points.value, name))}>
        {doubt.leaveOut}
      </button>
    </div>
  );
}

/** What lies where the point is proposed. */
export function DoubtCloseUp({ name }: { name: PointName }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const where = points.value.placed[name];
  const shown = current.value?.picture;
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
  announce(following ? questionOf(following) : messages.panel.doubt.noMore);
  // Its buttons are gone: keys go on at the picture.
  if (!following) document.querySelector<HTMLElement>(".stage")?.focus({ preventScroll: true });
}

/** The next click places it; dragging it and the arrow keys do as well. */
function move(name: PointName): void {
  change(ask(points.value, name));
  selected.value = name;
  document.querySelector<HTMLElement>(".stage")?.focus({ preventScroll: true });
  announce(messages.panel.doubt.clickWhere(messages.points.named[name]));
}
