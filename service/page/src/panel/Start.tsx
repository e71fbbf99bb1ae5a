// The start: what this is, how good, what becomes of pictures, and the ways in.
import { useSignal } from "@preact/signals";
import { messages } from "../messages";
import { AccuracyLine } from "../start/AccuracyLine";
import { GoOn } from "../start/GoOn";
import { KeptLine } from "../start/KeptLine";
import { Turning } from "../start/Turning";
import { Ways } from "../start/Ways";
import { isTouched } from "../ui/touch";
import { openFile, openProblem, trySample } from "./open";

const SAMPLES = [
  { name: "sample", width: 720, height: 960 },
  { name: "woman", width: 480, height: 640 },
  { name: "arm_across", width: 480, height: 640 },
] as const;

export function Start() {
  const { frame, start } = messages;
  const over = useSignal(false);
  return (
    <main class="start">
      <GoOn />
      <div
        class={`drop ${over.value ? "is-over" : ""}`}
        onDragOver={(event) => {
          event.preventDefault();
          over.value = true;
        }}
        onDragLeave={() => (over.value = false)}
        onDrop={(event) => {
          event.preventDefault();
          over.value = false;
          const file = event.dataTransfer?.files[0];
          if (file) void openFile(file);
        }}
      >
        <div class="drop-text is-head">
          <h1>{start.title}</h1>
          <AccuracyLine />
        </div>
        <Turning />
        <div class="drop-text">
          <Ways />
          {!isTouched && <p class="fine">{start.otherWays}</p>}
          <KeptLine />
          {openProblem.value && (
            <p class="note is-problem" role="alert">
              {openProblem.value}
            </p>
          )}
        </div>
      </div>
      <Samples />
      <a class="is-narrow-only" href="/documentation/">
        {frame.documentation}
      </a>
    </main>
  );
}

function Samples() {
  const { samples } = messages.start;
  return (
    <section class="samples" aria-labelledby="samples-title">
      <h2 id="samples-title">{samples.title}</h2>
      <ul>
        {SAMPLES.map(({ name, width, height }) => (
          <li key={name}>
            <button type="button" onClick={() => void trySample(name)}>
              <img src={`/page/${name}.jpg`} alt={samples.pictured[name]} width={width} height={height} />
              <span>{samples.labels[name]}</span>
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}
