// The window that shows this page in a frame: what it says, and what it is told. Messages of other windows are not heard.

type Hear = (message: Readonly<Record<string, unknown>> & { readonly type: string }) => void;

/** The site's origin, known from its first start on: nobody else is told anything but that the page is there. */
let site: string | null = null;

export const isFramed = window.parent !== window;

export function tell(message: Maquette.FromFrame): void {
  if (site !== null) window.parent.postMessage(message, site);
}

/** Hear what the site says, and let it know that it may speak. */
export function listen(hear: Hear): void {
  addEventListener("message", ({ data, source, origin }: MessageEvent<unknown>) => {
    if (!isFramed || source !== window.parent || !isOurs(data)) return;
    if (site === null && data.type === "maquette:start") site = origin;
    if (origin === site) hear(data);
  });
  // Whose frame it is nobody knows yet. It tells nothing, and frame-ancestors names who may show this page at all.
  const ready: Maquette.FromFrame = { type: "maquette:ready", version: 1 };
  if (isFramed) window.parent.postMessage(ready, "*");
}

/** Sites send their frames other messages too. */
function isOurs(data: unknown): data is Parameters<Hear>[0] {
  return typeof data === "object" && data !== null && "type" in data && typeof data.type === "string" && data.type.startsWith("maquette:");
}
