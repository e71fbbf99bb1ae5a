// The start: what this is, how good, what becomes of pictures, and the way in.
import { useSignal } from "@preact/signals";
import { current, labels, views } from "../draft/draft";
import { discard, openFiles, openProblem, trySample } from "../draft/open";
import type { Sample } from "../draft/open";
import { messages } from "../messages";
import { PREPARE_ADDRESS } from "../route";
import { FileButton } from "../ui/FileButton";
import { Icon } from "../ui/Icon";
import { IS_TOUCHED } from "../ui/narrow";
import { AccuracyLine } from "./AccuracyLine";
import { HowTo } from "./HowTo";
import { KeptLine } from "./KeptLine";
import { Turning } from "./Turning";

interface Shown extends Sample {
  readonly name: keyof typeof messages.start.samples.labels;
  readonly width: number;
  readonly height: number;
}

const SAMPLES: readonly Shown[] = [
  { name: "sample", pictures: ["sample.jpg"], request: "sample.json", width: 720, height: 960 },
  { name: "woman", pictures: ["woman.jpg"], request: "woman.json", width: 480, height: 640 },
  { name: "arm_across", pictures: ["arm_across.jpg"], request: "arm_across.json", width: 480, height: 640 },
  { name: "pair", pictures: ["front.jpg", "side.jpg"], request: "front_and_side.json", width: 480, height: 640 },
];

export function Start() {
  const { start } = messages;
  const over = useSignal(false);
  return (
    <main class="start">
      {current.value && <GoOn />}
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
          const files = [...(event.dataTransfer?.files ?? [])];
          if (files.length > 0) void openFiles(files);
        }}
      >
        <div class="drop-text is-head">
          <h1>{start.title}</h1>
        </div>
        <Turning />
        <div class="drop-text">
          <p class="row">
            <FileButton look="button is-primary" multiple onChoose={(files) => void openFiles(files)}>
              <Icon name="picture" />
              {IS_TOUCHED ? start.take : start.choose}
            </FileButton>
          </p>
          <p>{start.ways}</p>
          <AccuracyLine />
          {!IS_TOUCHED && <p class="fine">{start.otherWays}</p>}
          <KeptLine />
          {openProblem.value && (
            <p class="note is-problem" role="alert">
              {openProblem.value}
            </p>
          )}
        </div>
      </div>
      <Samples />
      <HowTo />
    </main>
  );
}

/** A fit that is being prepared already: back to it, or rid of it. */
function GoOn() {
  const { goOn } = messages.start;
  const { picture } = current.value!;
  return (
    <div class="go-on">
      <img src={picture.url} alt="" />
      <a class="button is-primary" href={PREPARE_ADDRESS}>
        <span>{goOn.with(views.value.length > 1 ? labels.value.join(", ") : picture.name)}</span>
      </a>
      <button class="link" type="button" onClick={discard}>
        {goOn.discard}
      </button>
    </div>
  );
}

function Samples() {
  const { samples } = messages.start;
  return (
    <section class="samples" aria-labelledby="samples-title">
      <h2 id="samples-title">{samples.title}</h2>
      <ul>
        {SAMPLES.map((sample) => (
          <li key={sample.name}>
            <button type="button" onClick={() => void trySample(sample)}>
              <img src={`/page/${sample.pictures[0]}`} alt={samples.pictured[sample.name]} width={sample.width} height={sample.height} />
              <span>{samples.labels[sample.name]}</span>
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}
