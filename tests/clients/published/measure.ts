// What somebody writes who has the published client: a fit, a scan, their files, and a request that is refused.
import { Maquette, MaquetteError } from "maquette-client";

export async function measured(address: string, picture: Blob, other: Blob) {
  const maquette = new Maquette({ address });
  const states: string[] = [];
  const known = { gender: "female", height_m: 1.68, points: "auto" } as const;
  const fit = await maquette.fit(picture, known, { wait: 0 });
  const done = await maquette.waitFor(fit, { onProgress: ({ state }) => states.push(state) });
  const found = await maquette.result(done);
  const glb = await maquette.artifact(done, "body_posed.glb");
  const whole = await maquette.result(done, { stages: true });

  const views = [{ view: "front" }, { view: "side" }] as const;
  const scan = await maquette.waitFor(await maquette.scan([picture, other], { gender: "female", views: [...views] }));
  const { views: seen, measurements } = await maquette.result(scan);
  await maquette.erase(done);
  await maquette.erase(scan);

  const refused = await maquette.fit(picture, { ...known, height_m: 9 }).catch((error: unknown) => error);
  if (!(refused instanceof MaquetteError)) throw new Error("nobody is nine metres tall");
  const gone = await maquette.result(done).catch((error: unknown) => error instanceof MaquetteError && error.status);
  return {
    states,
    waist: [found, { measurements }].map((each) => each.measurements[0]?.value),
    interval: [found.measurements[0]?.low, found.measurements[0]?.high],
    stages: [found.stages.length, whole.stages.length],
    views: seen.map(({ view }) => view),
    glb: (await glb.text()).slice(0, 4),
    refused: [refused.status, refused.problem?.errors?.[0]?.field],
    gone,
  };
}

// The types are those of the document: each of these must be an error.
declare const maquette: Maquette;
// @ts-expect-error a gender is needed
export const nobody = () => maquette.fit(new Blob(), { points: "auto" });
// @ts-expect-error a fit has no agreement
export const alone = async () => (await maquette.result(await maquette.fit(new Blob(), { gender: "male", points: "auto" }))).agreement;
