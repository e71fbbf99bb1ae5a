// A picture of what was made; one that moves can be held still, and is for those who want calm.
import { useState } from "preact/hooks";
import type { Derivation } from "../api/types";
import { messages } from "../messages";
import { usePictureOf } from "../result/files";
import type { Shows } from "./kinds/kind";

export function ProductPicture({ made, shows: { file, still, alt, caption } }: { made: Derivation; shows: Shows }) {
  const [held, hold] = useState(() => matchMedia("(prefers-reduced-motion: reduce)").matches);
  const wanted = still && held ? still : file;
  const url = usePictureOf(made, wanted, true);
  return (
    <>
      <div class="look-room">
        {url && (
          <img
            key={url}
            class="product-picture"
            src={url}
            alt={alt()}
            onLoad={({ currentTarget: image }) => {
              image.dataset.shows = wanted;
            }}
          />
        )}
      </div>
      {(caption || still) && (
        <div class="look-bar">
          {caption && <p class="fine">{caption()}</p>}
          {still && (
            <button class="button is-small" type="button" onClick={() => hold(!held)}>
              {held ? messages.derived.play : messages.derived.hold}
            </button>
          )}
        </div>
      )}
    </>
  );
}
