// Files to keep: what each is, a mesh in other formats too.
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
const FORMATS = ["obj", "ply", "stl"];

interface Props {
  /** Paths by name. */
  readonly files: Readonly<Record<string, string>>;
  /** Bytes by name, as far as they are known. */
  readonly sizes?: ReadonlyMap<string, number>;
}

export function Downloads({ files, sizes }: Props) {
  const order = Object.keys(messages.files.labels);
  const rank = (name: string) => (order.includes(plain(name)) ? order.indexOf(plain(name)) : order.length);
  const sorted = Object.entries(files).sort(([a], [b]) => rank(a) - rank(b));
  return (
    <ul class="downloads">
      {sorted.map(([name, path]) => (
        <li key={name}>
          <Download name={name} path={path} bytes={sizes?.get(name)} />
        </li>
      ))}
    </ul>
  );
}

function Download({ name, path, bytes }: { name: string; path: string; bytes?: number }) {
  const problem = useSignal<Problem | null>(null);
  const keep = async (kept: string, from: string) => {
    try {
      saveFile(kept.replaceAll("/", "_"), await getFile(from));
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
          <small>{wordFor(messages.files.labels, plain(name))}</small>
        </span>
        <small>{sizeText(bytes)}</small>
      </button>
      {name.endsWith(".glb") && (
        <p class="download-formats">
          {FORMATS.map((ending) => (
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

/** Without the picture that it is of. */
function plain(name: string): string {
  return name.replace(/^views\/\d+\//, "");
}

function withEnding(name: string, ending: string): string {
  return name.replace(/glb$/, ending);
}

function sizeText(bytes: number | undefined): string {
  if (bytes === undefined) return "";
  return bytes < 1e6 ? measured(Math.max(1, bytes / 1e3), "kilobyte") : measured(bytes / 1e6, "megabyte", 1);
}
