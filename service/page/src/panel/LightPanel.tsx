// Where the light comes from: a ball to be lit by dragging.
import { useLayoutEffect, useRef } from "preact/hooks";
import type { LightGuess } from "../api/types";
import { cues, light, surroundings } from "../draft/draft";
import { messages } from "../messages";
import { Choice } from "../ui/Choice";
import { fromHeight, fromSide } from "../ui/direction";
import { drawBall, lightAt } from "./ball";

const SIDE_PX = 96;
const STEP_DEG = 5;

export function LightPanel() {
  const { light: words } = messages.panel;
  const guess = light.value;
  return (
    <div class="subsection">
      <h3>{words.title}</h3>
      <div class="light">
        <Ball guess={guess} />
        <div>
          <p class="fine">
            {guess ? words.guessed(wordsFor(guess)) : words.found}
          </p>
          {guess && (
            <>
              <Choice
                name="light-kind"
                legend={words.kind}
                quiet
                options={[
                  { value: "point", label: words.lamp },
                  { value: "directional", label: words.sun },
                ]}
                value={guess.kind ?? "point"}
                onChange={(kind) => (light.value = { ...guess, kind })}
              />
              <button class="link" type="button" onClick={() => (light.value = null)}>
                {words.leave}
              </button>
            </>
          )}
        </div>
      </div>
      {cues.value === "SES" && (
        <>
          <Choice
            name="surroundings"
            legend={words.surroundings}
            options={[
              { value: "uniform", label: words.even, title: words.evenTitle },
              { value: "spherical_harmonics", label: words.byDirection, title: words.byDirectionTitle },
            ]}
            value={surroundings.value}
            onChange={(kind) => (surroundings.value = kind)}
          />
          <p class="fine">
            {surroundings.value === "uniform" ? words.evenHelp : words.byDirectionHelp}
          </p>
        </>
      )}
    </div>
  );
}

function Ball({ guess }: { guess: LightGuess | null }) {
  const { light: words } = messages.panel;
  const canvas = useRef<HTMLCanvasElement>(null);
  // Before it is shown: what it says and what is seen are never of two lights.
  useLayoutEffect(() => drawBall(canvas.current!, guess), [guess]);
  const set = (azimuth: number, elevation: number) => {
    const azimuth_deg = Math.round(Math.max(-90, Math.min(90, azimuth)));
    const elevation_deg = Math.round(Math.max(-90, Math.min(90, elevation)));
    light.value = { kind: guess?.kind ?? "point", azimuth_deg, elevation_deg };
  };
  const drag = (event: PointerEvent) => {
    const box = canvas.current!.getBoundingClientRect();
    const at = lightAt(
      (2 * (event.clientX - box.left)) / box.width - 1,
      (2 * (event.clientY - box.top)) / box.height - 1,
    );
    set(at.azimuth_deg, at.elevation_deg);
  };
  return (
    <canvas
      ref={canvas}
      class="ball"
      width={2 * SIDE_PX}
      height={2 * SIDE_PX}
      tabIndex={0}
      role="slider"
      aria-label={words.ball}
      aria-valuemin={-90}
      aria-valuemax={90}
      aria-valuenow={guess?.azimuth_deg ?? 0}
      aria-valuetext={guess ? wordsFor(guess) : words.leftToFit}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        drag(event);
      }}
      onPointerMove={(event) => {
        if (event.currentTarget.hasPointerCapture(event.pointerId)) drag(event);
      }}
      onKeyDown={(event) => {
        const turn = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
        if (!turn) return;
        event.preventDefault();
        set((guess?.azimuth_deg ?? 0) + STEP_DEG * turn[0]!, (guess?.elevation_deg ?? 0) + STEP_DEG * turn[1]!);
      }}
    />
  );
}

function wordsFor({ azimuth_deg, elevation_deg }: LightGuess): string {
  const [azimuth, elevation] = [azimuth_deg ?? 0, elevation_deg ?? 0];
  const across = Math.abs(azimuth) < 3 ? [messages.panel.light.straight] : [fromSide(azimuth)];
  const along = Math.abs(elevation) < 3 ? [] : [fromHeight(elevation)];
  return [...across, ...along].join(", ");
}
