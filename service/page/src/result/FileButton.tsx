// A file of a result: what it is, and how to keep it, a mesh in other formats too.
import { useSignal } from "@preact/signals";
import { getFile } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Problem } from "../api/types";
import { wordFor } from "../messages/words";
import { measured } from "../messages/figures";
import { messages } from "../messages";
import { Icon } from "../ui/Icon";
import { ProblemNote } from "../ui/ProblemNote";
import { saveFile } from "../ui/save";

/** What the service writes of any mesh when it is asked for. */
const FORMATS = ["obj", "ply", "stl", "usdz"];

/** The material of an OBJ with a texture is a file beside it. */
const TEXTURED = "body_textured.glb";

export function FileButton({ name, path, bytes }: { name: string; path: string; bytes?: number }) {
  const { labels } = messages.files;
  const problem = useSignal<Problem | null>(null);
  const keep = async (kept: string, from: string) => {
    try {
      saveFile(kept, await getFile(from));
      problem.value = null;
    } catch (error) {
      problem.value = problemFrom(error);
    }
  };
  return (
    <>
      <button class="download" type="button" onClick={() => keep(name, path)}>
        <Icon name="download" />
        <span>
          {name}
          <small>{wordFor(labels, name) ?? wordFor(labels, name.replace(/_\d+\./, "_N."))}</small>
        </span>
        <small>{sizeText(bytes)}</small>
      </button>
      {name.endsWith(".glb") && (
        <p class="download-formats">
          {[...FORMATS, ...(name === TEXTURED ? ["mtl"] : [])].map((ending) => (
            <button
              key={ending}
              class="link"
              type="button"
              aria-label={withEnding(name, ending)}
              onClick={() => keep(withEnding(name, ending), withEnding(path, ending))}
            >
              {ending.toUpperCase()}
            </button>
          ))}
        </p>
      )}
      {problem.value && <ProblemNote problem={problem.value} />}
    </>
  );
}

function withEnding(name: string, ending: string): string {
  return name.replace(/glb$/, ending);
}

function sizeText(bytes: number | undefined): string {
  if (bytes === undefined) return "";
  return bytes < 1e6 ? measured(Math.max(1, bytes / 1e3), "kilobyte") : measured(bytes / 1e6, "megabyte", 1);
}
