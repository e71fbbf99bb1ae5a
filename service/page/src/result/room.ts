// Links by which a phone shows a body in the room it is in.

interface Device {
  /** Whether the browser follows links that are marked so: Safari on iOS. */
  readonly followsAr: boolean;
  readonly isAndroid: boolean;
  /** The page's own address. */
  readonly page: string;
  /** Other programs than the page have no key. */
  readonly needsKey: boolean;
}

export interface RoomLink {
  readonly href: string;
  readonly rel?: "ar";
}

/** To the body at the path of its GLB file; null where no program of the device could fetch or show it. */
export function roomLink(glb: string, { followsAr, isAndroid, page, needsKey }: Device): RoomLink | null {
  if (needsKey) return null;
  if (followsAr) return { href: glb.replace(/glb$/, "usdz"), rel: "ar" };
  const file = new URL(glb, page);
  // The viewer of Android is a program of its own, and fetches by https alone.
  if (!isAndroid || file.protocol !== "https:") return null;
  const asked = new URLSearchParams({ file: file.href, mode: "ar_preferred", resizable: "false" });
  return {
    href: `intent://arvr.google.com/scene-viewer/1.0?${asked}#Intent;scheme=https;package=com.google.android.googlequicksearchbox;action=android.intent.action.VIEW;end;`,
  };
}

export function thisDevice(needsKey: boolean): Device {
  return {
    followsAr: document.createElement("a").relList.supports("ar"),
    isAndroid: /android/i.test(navigator.userAgent),
    page: location.href,
    needsKey,
  };
}
