// The page as a part of another site: it waits to be told whom to measure, and tells what came out.
import { batch, effect } from "@preact/signals";
import { render } from "preact";
import { present } from "../api/key";
import { openPicture } from "../draft/chosen";
import type { Picture } from "../draft/picture";
import { loadPerson } from "../draft/request";
import { keepNothing } from "../history/store";
import { isFilming } from "../measure/lens";
import { PLACES, PLACE_NAMES, emptyPlace } from "../measure/places";
import type { PlaceName } from "../measure/places";
import { languageOf, load } from "../messages/language";
import { MEASURE_ADDRESS, go } from "../route";
import { useTheme } from "../ui/theme";
import { EmbedView } from "./EmbedView";
import { allow } from "./allowed";
import { startTelling } from "./outcome";
import { listen, tell } from "./parent";
import { faultOfStart, faultOfTheme, faultOfToken } from "./reading";
import type { Refusal } from "./reading";
import { isStarted } from "./started";
import { startAsking, takeToken } from "./token";

export function startEmbedding(root: HTMLElement): void {
  // A key that somebody typed into this page elsewhere is not the site's, nor is the list of fits.
  present(null);
  keepNothing();
  document.documentElement.classList.add("is-embedded");
  render(<EmbedView />, root);
  startAsking();
  startTelling();
  effect(() => tell({ type: "maquette:camera", open: isFilming.value }));
  new ResizeObserver(() => tellHeight(root)).observe(root);
  // As soon as the camera's frame is as large as before, whatever was shown meanwhile.
  addEventListener("resize", () => tellHeight(root));
  listen((message) => {
    if (message.type === "maquette:start") void start(message as unknown as Maquette.Start, root);
    else if (message.type === "maquette:token") renew(message["token"]);
    else if (message.type === "maquette:theme") retheme(message["theme"]);
    else refuse({ field: "type", reason: "Send maquette:start, maquette:token or maquette:theme." });
  });
}

async function start(message: Maquette.Start, root: HTMLElement): Promise<void> {
  const fault = faultOfStart(message);
  if (fault) return refuse(fault);
  const { token, lang, theme, subject, pictures, allow: allowed } = message;
  const spoken = lang ? languageOf(lang) : null;
  if (spoken) await load(spoken);
  const opened = await openedPictures(pictures ?? {});
  if ("reason" in opened) return refuse(opened);
  if (theme) useTheme(theme);
  if (token) takeToken(token);
  batch(() => {
    if (allowed) allow(allowed);
    if (subject) loadPerson({ ...subject, gender: subject.gender ?? undefined });
    for (const name of PLACE_NAMES) {
      const picture = opened[name];
      if (!picture) continue;
      emptyPlace(PLACES[name]);
      PLACES[name].picture.value = picture;
    }
    if (!isStarted.value || subject || pictures) go(MEASURE_ADDRESS);
    isStarted.value = true;
  });
  tellHeight(root);
}

async function openedPictures(pictures: Maquette.Pictures): Promise<Partial<Record<PlaceName, Picture>> | Refusal> {
  const opened: Partial<Record<PlaceName, Picture>> = {};
  for (const name of PLACE_NAMES) {
    const file = pictures[name];
    if (!file) continue;
    try {
      // The site's file itself cannot be uploaded from here: Chromium does not let this process read it for that.
      const copy = new Blob([await file.arrayBuffer()], { type: file.type });
      opened[name] = await openPicture(copy, file instanceof File ? file.name : name);
    } catch (error) {
      return { field: `pictures.${name}`, reason: error instanceof Error ? error.message : String(error) };
    }
  }
  return opened;
}

function renew(token: unknown): void {
  const fault = faultOfToken(token);
  if (fault) refuse(fault);
  else takeToken(token as string);
}

function retheme(theme: unknown): void {
  const fault = faultOfTheme(theme);
  if (fault) refuse(fault);
  else useTheme(theme as Maquette.Theme);
}

function refuse({ field, reason }: Refusal): void {
  tell({ type: "maquette:refused", field, reason });
}

/** While the camera fills the window, the frame is not as wide as where the site has it. */
function tellHeight(root: HTMLElement): void {
  if (isFilming.value) return;
  tell({ type: "maquette:resize", height: Math.ceil(root.getBoundingClientRect().height) });
}
