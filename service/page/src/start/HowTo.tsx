// How to take pictures that measure well: rules, and good pictures beside bad ones.
import { useSignal } from "@preact/signals";
import { messages } from "../messages";

/** In the order of the strip of pictures that `tests/illustrations/measuring_sheet.py` draws; bad ones by what is found in them. */
const GOOD = ["front", "armsForward", "armsHanging"] as const;
const BAD = [
  "cut-off", "person-too-small", "picture-too-small", "camera-too-near", "camera-rolled", "other-view", "arms-against-trunk",
  "clothes-loose", "blurred", "too-dark", "too-bright", "several-people",
] as const;
const TILES = [...GOOD, ...BAD];

const STRIP = "/page/measuring_tiles.jpg";
const WIDTH = 120;
const HEIGHT = 160;
/** Of a tile left out on either side, where the compression mixes neighbours. */
const EDGE = 1;

export function HowTo() {
  const { howto } = messages;
  const opened = useSignal(false);
  return (
    <details class="howto" onToggle={(event) => (opened.value ||= event.currentTarget.open)}>
      <summary>{howto.title}</summary>
      <ul class="howto-rules">
        {howto.rules.map((rule) => (
          <li key={rule}>{rule}</li>
        ))}
      </ul>
      {opened.value && (
        <ul class="howto-tiles">
          {TILES.map((tile, at) => {
            const isGood = at < GOOD.length;
            const { what, remedy } = howto.tiles[tile];
            return (
              <li key={tile} class={isGood ? "is-good" : "is-bad"} data-code={isGood ? "good" : tile}>
                <svg viewBox={`${at * WIDTH + EDGE} 0 ${WIDTH - 2 * EDGE} ${HEIGHT}`} preserveAspectRatio="none" aria-hidden="true">
                  <image href={STRIP} width={TILES.length * WIDTH} height={HEIGHT} />
                </svg>
                <strong>{isGood ? howto.good(what) : howto.bad(what)}</strong>
                <span>{remedy}</span>
              </li>
            );
          })}
        </ul>
      )}
    </details>
  );
}
