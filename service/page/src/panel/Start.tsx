// Before there is a picture: drop, paste, choose or take one, or try the sample.
import { useSignal } from "@preact/signals";
import { Icon } from "../ui/Icon";
import { openFile, openProblem, trySample } from "./open";

export function Start() {
  const over = useSignal(false);
  return (
    <main class="start">
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
        <div class="drop-text">
          <h1>A body from one picture</h1>
          <p class="lead">
            Click the joints of a person in a photograph or painting. You get the posed body in 3D, its measurements, and
            the light it stands in.
          </p>
          <div class="row">
            <label class="button is-primary">
              <Icon name="picture" />
              Choose a picture
              <input
                class="unseen"
                type="file"
                accept="image/*"
                onChange={(event) => {
                  const file = event.currentTarget.files?.[0];
                  event.currentTarget.value = "";
                  if (file) void openFile(file);
                }}
              />
            </label>
            <button class="button" type="button" onClick={() => void trySample(false)}>
              Try the sample
            </button>
          </div>
          <p class="fine">You can also drop a picture here, or paste one. On a phone the camera is offered.</p>
          {openProblem.value && (
            <p class="note is-problem" role="alert">
              {openProblem.value}
            </p>
          )}
        </div>
        <figure class="start-sample">
          <button type="button" onClick={() => void trySample(true)}>
            <img src="/page/sample.jpg" alt="A man stands before a grey wall, lit from the left" width="720" height="960" />
            <span>Sample, points already placed</span>
          </button>
        </figure>
      </div>
      <ol class="start-steps">
        <li>
          <b>Click</b> at least six joints. The body follows as you click.
        </li>
        <li>
          <b>Say</b> what you know: height, weight, lens, light. Unknown is allowed.
        </li>
        <li>
          <b>Look</b> at the body over the picture, from every side, and at what it measures.
        </li>
      </ol>
    </main>
  );
}
