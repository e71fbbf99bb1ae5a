// What somebody writes who has the published client: fits, their files, a product, and a request that is refused.
import { Maquette, MaquetteError } from "maquette-client";

export async function measured(address: string, picture: Blob, other: Blob) {
  const maquette = new Maquette({ address });
  const states: string[] = [];
  const known = { gender: "female", height_m: 1.68 } as const;
  const fit = await maquette.fit(known, [picture], { onProgress: ({ state }) => states.push(state) });
  const found = await maquette.result(fit);
  const glb = await maquette.file(fit, "body_canonical.glb");
  const posed = await maquette.product(fit, { kind: "pose", pose: "sitting" }, {}, ({ state }) => states.unshift(state));
  const reposed = await maquette.file(posed, "body_reposed.glb");

  const views = [{ view: "front" }, { view: "side" }] as const;
  const several = await maquette.fit({ gender: "female", views: [...views] }, [picture, other]);
  const { views: seen, measurements } = await maquette.result(several);
  await maquette.erase(fit);
  await maquette.erase(several);

  const refused = await maquette.fit({ ...known, height_m: 9 }, [picture]).catch((error: unknown) => error);
  if (!(refused instanceof MaquetteError)) throw new Error("nobody is nine metres tall");
  const gone = await maquette.result(fit).catch((error: unknown) => error instanceof MaquetteError && error.status);
  return {
    states,
    waist: [found, { measurements }].map((each) => each.measurements[0]?.value),
    interval: [found.measurements[0]?.low, found.measurements[0]?.high],
    stages: found.stages.length,
    views: seen.map(({ view }) => view),
    glb: await Promise.all([glb, reposed].map(async (each) => (await each.text()).slice(0, 4))),
    refused: [refused.status, refused.problem?.errors?.[0]?.field],
    gone,
  };
}

// The types are those of the document: each of these must be an error.
declare const maquette: Maquette;
// @ts-expect-error a gender is needed
export const nobody = () => maquette.fit({ height_m: 1.7 }, [new Blob()]);
// @ts-expect-error there is no such product
export const bust = async () => maquette.product(await maquette.fit({ gender: "male" }, [new Blob()]), { kind: "bust" });
