// A motion played, stopped, sought and slowed down.
import { useEffect, useState } from "preact/hooks";
import { seconds } from "../messages/figures";
import { messages } from "../messages";
import { Choice } from "../ui/Choice";
import type { DerivedScene } from "./DerivedScene";

const SPEEDS = ["0.25", "0.5", "1"] as const;

interface Props {
  readonly scene: DerivedScene;
  /** Seconds. */
  readonly length: number;
}

export function MotionBar({ scene, length }: Props) {
  const { motion: words } = messages.products;
  const [plays, play] = useState(() => !matchMedia("(prefers-reduced-motion: reduce)").matches);
  const [speed, setSpeed] = useState<(typeof SPEEDS)[number]>("1");
  const [at, seek] = useState(0);
  useEffect(() => scene.showMoment(at), [at]);
  useEffect(() => {
    if (!plays) return undefined;
    let before = performance.now();
    let scheduled = 0;
    const step = (now: number) => {
      const by = (Number(speed) * (now - before)) / 1000;
      before = now;
      seek((old) => (old + by) % length);
      scheduled = requestAnimationFrame(step);
    };
    scheduled = requestAnimationFrame(step);
    return () => cancelAnimationFrame(scheduled);
  }, [plays, speed]);
  return (
    <div class="look-bar motion-bar">
      <button class="button is-small" type="button" onClick={() => play(!plays)}>
        {plays ? words.stop : words.play}
      </button>
      <label class="slider">
        <input
          type="range"
          min="0"
          max={length}
          step="0.01"
          value={at}
          aria-label={words.moment}
          aria-valuetext={seconds(at, 1)}
          onInput={(event) => {
            play(false);
            seek(Number(event.currentTarget.value));
          }}
        />
        <output>{seconds(at, 1)}</output>
      </label>
      <Choice name="speed" legend={words.speed} quiet options={SPEEDS.map((value) => ({ value, label: words.times(value) }))} value={speed} onChange={setSpeed} />
    </div>
  );
}
