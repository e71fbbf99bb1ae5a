// What most people want to keep: the table, the body as a mesh, with its skin too, and the body in their own room.
import { useSignal } from "@preact/signals";
import { getFile } from "../api/calls";
import { problemFrom } from "../api/client";
import { apiKey } from "../api/key";
import { nameOfView } from "../api/fits";
import type { Fit } from "../api/fits";
import type { Problem } from "../api/types";
import { messages } from "../messages";
import { Icon } from "../ui/Icon";
import { ProblemNote } from "../ui/ProblemNote";
import { saveFile } from "../ui/save";
import { tableOf, usePictureOf } from "./files";
import { roomLink, thisDevice } from "./room";

const BODY = "body_canonical.glb";
const MESHES = ["glb", "obj", "usdz"] as const;
const TEXTURED = "body_textured.glb";

interface Props {
  readonly fit: Fit;
  readonly hasTable: boolean;
  /** Where the body with its skin is; null until it is made. */
  readonly skin: string | null;
}

export function Keep({ fit, hasTable, skin }: Props) {
  const { keep: words } = messages.files;
  const problem = useSignal<Problem | null>(null);
  const save = async (name: string, path: string) => {
    try {
      saveFile(name, await getFile(path));
      problem.value = null;
    } catch (error) {
      problem.value = problemFrom(error);
    }
  };
  const body = fit.links.artifacts?.[BODY];
  const room = body ? roomLink(body, thisDevice(apiKey.value !== null)) : null;
  const [table, tablePath] = tableOf(fit);
  return (
    <details class="keep">
      <summary class="button is-primary is-small">
        <Icon name="download" />
        {words.title}
      </summary>
      <div class="row">
        {hasTable && (
          <button class="button is-small" type="button" onClick={() => save(table, tablePath)}>
            <Icon name="download" />
            {words.table}
          </button>
        )}
        {body &&
          MESHES.map((ending) => (
            <button
              key={ending}
              class="button is-small"
              type="button"
              title={words.meshes[ending]}
              onClick={() => save(BODY.replace(/glb$/, ending), body.replace(/glb$/, ending))}
            >
              <Icon name="download" />
              {words.mesh(ending.toUpperCase())}
            </button>
          ))}
        {skin && (
          <button class="button is-small" type="button" title={words.skinTitle} onClick={() => save(TEXTURED, skin)}>
            <Icon name="download" />
            {words.skin}
          </button>
        )}
      </div>
      {room && <InRoom fit={fit} {...room} />}
      {problem.value && <ProblemNote problem={problem.value} />}
    </details>
  );
}

/** iOS takes a link for one to a body in the room only if a picture is all it holds. */
function InRoom({ fit, href, rel }: { fit: Fit; href: string; rel?: "ar" }) {
  const { keep: words } = messages.files;
  const url = usePictureOf(fit, nameOfView(fit, "views.png", 0), rel === "ar");
  return (
    <p class="in-room">
      <a href={href} rel={rel}>
        {rel === "ar" ? <img src={url ?? ""} alt={words.room} /> : words.room}
      </a>
      {rel === "ar" && <span class="fine">{words.room}</span>}
    </p>
  );
}
