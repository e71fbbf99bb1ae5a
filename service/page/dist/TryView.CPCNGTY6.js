import{a as _}from"/page/chunk.BO4432M3.js";import{a as x}from"/page/chunk.KNCKVWUI.js";import{b as v}from"/page/chunk.WMFCKWMR.js";import"/page/chunk.TADDU3B6.js";import"/page/chunk.B5PTHFFQ.js";import"/page/chunk.T4JVJVL2.js";import"/page/chunk.ALXSJT4W.js";import{a as O}from"/page/chunk.PWRSD2CO.js";import"/page/chunk.3GZYOKFI.js";import{B as T,i as E,p as A,x as S}from"/page/chunk.OVKTZG77.js";import{a as F}from"/page/chunk.X45HYFZM.js";import{d as k,m as u,o as t}from"/page/chunk.K74SRY7O.js";import"/page/chunk.OTD3EZO2.js";import{k as c}from"/page/chunk.57RVQIIW.js";import"/page/chunk.4YB65RXQ.js";import"/page/chunk.F5XGFZ2T.js";var m={curl:({origin:e,name:n,isSample:o,request:i,hasKey:a})=>{let s=`curl -sf${a?' -H "Authorization: Bearer $MAQUETTE_API_KEY"':""}`,l=o?n:`"${n.replace(/["\\]/g,"\\$&")}"`;return`${o?`curl -sfO ${e}/page/${n}
`:""}FIT=$(${s} -H 'Prefer: wait=60' \\
  -F ${P(`image=@${l}`)} \\
  -F ${P(`request=${i}`)} \\
  -o /dev/null -w '%header{location}' ${e}/v1/fits)
${s} ${e}$FIT/result`},fetch:({origin:e,name:n,isSample:o,request:i,hasKey:a})=>`const { openAsBlob } = await import("node:fs");
const service = "${e}";
const picture = await ${o?`(await fetch(service + "/page/${n}")).blob()`:`openAsBlob(${JSON.stringify(n)})`};
const headers = { Prefer: "wait=60"${a?", Authorization: `Bearer ${process.env.MAQUETTE_API_KEY}`":""} };

const body = new FormData();
body.append("image", picture);
body.append("request", JSON.stringify(${i}));
const answer = await fetch(service + "/v1/fits", { method: "POST", headers, body });
const fit = await answer.json();
if (fit.state !== "succeeded") throw new Error(JSON.stringify(fit));
const result = await fetch(service + fit.links.result, { headers });
console.log(await result.text());`.replace(o?/^.*\n/:"",""),python:({origin:e,name:n,isSample:o,request:i,hasKey:a})=>`${a?`import os

`:""}import httpx

service = "${e}"
picture = ${o?`httpx.get(service + "/page/${n}").content`:`open(${JSON.stringify(n)}, "rb").read()`}
headers = {"Prefer": "wait=60"${a?', "Authorization": "Bearer " + os.environ["MAQUETTE_API_KEY"]':""}}

with httpx.Client(base_url=service, headers=headers, timeout=90) as client:
    data = {"request": r'''${i}'''}
    answer = client.post("/v1/fits", files={"image": picture}, data=data)
    fit = answer.raise_for_status().json()
    print(client.get(fit["links"]["result"]).raise_for_status().text)`};function P(e){return`'${e.replaceAll("'","'\\''")}'`}var C="sample.jpg",N=h({gender:"male",height_m:1.804,views:[{view:"front"}]}),I=h({gender:null,height_m:null,views:[{view:"front"}]});function W(){let{trying:e}=c,n=u(null),o=u(N),i=u(null),a=u(null),s=u(null),l=u("curl");k(()=>()=>s.value?.abort(),[]);let f=(r,p=n.value)=>{s.value?.abort(),s.value=i.value=null,a.value=null,o.value=r,n.value=p},y=async()=>{f(o.value);let{signal:r}=s.value=new AbortController,p=null;try{let g=n.value??await(await fetch(`/page/${C}`)).blob(),d=await S(g,q(o.value),r);p=d.state==="succeeded"?await T(d.id):d,!r.aborted&&d.state==="succeeded"&&(a.value=d)}catch(g){p=A(g)}r.aborted||(i.value=p,s.value=null,v(e.answered))},w=r=>r&&f(I,r),$={origin:location.origin,name:n.value?.name??C,isSample:n.value===null,request:q(o.value),hasKey:E.value!==null};return t("main",{class:"try",onDragOver:r=>r.preventDefault(),onDrop:r=>{r.preventDefault(),w(r.dataTransfer?.files[0])},children:[t("section",{children:[t("h1",{children:e.title}),t("p",{class:"row",children:[t("button",{class:"button is-primary",type:"button",onClick:()=>(f(N,null),void y()),children:e.sample}),t(O,{look:"button",onChoose:([r])=>w(r),children:e.choose})]}),t(b,{label:e.request($.name),text:o.value,rows:11,onEdit:f}),t("button",{class:"button",type:"button",disabled:s.value!==null,onClick:()=>{y()},children:s.value?c.frame.sending:e.send}),t(F,{name:"language",legend:e.as,quiet:!0,options:Object.keys(m).map(r=>({value:r,label:e.languages[r]})),value:l.value,onChange:r=>l.value=r}),t(b,{label:e.languages[l.value],text:m[l.value]($),rows:16})]}),t("section",{"aria-busy":s.value!==null,children:t(b,{label:e.response,text:i.value?h(i.value):"",rows:36})}),t("section",{children:[t("h2",{children:e.body}),a.value&&t(B,{fit:a.value},a.value.id),t("a",{href:"/docs",children:e.reference})]})]})}function B({fit:e}){let n=_(e.id,!0);return n.state==="coming"?t("p",{class:"fine",children:c.look.skinComes}):t(x,{path:e.links.files["body_canonical.glb"],skin:n.path,label:c.trying.body})}function b({label:e,text:n,rows:o,onEdit:i}){let{copy:a,copied:s}=c.trying;return t("div",{class:"try-code",children:[t("h2",{children:e}),t("button",{class:"link",type:"button",onClick:()=>{navigator.clipboard.writeText(n).then(()=>v(s))},children:a(e)}),t("textarea",{"aria-label":e,rows:o,wrap:"off",spellcheck:!1,readOnly:!i,value:n,onInput:l=>i?.(l.currentTarget.value)})]})}function h(e){return JSON.stringify(e,null,2)}function q(e){try{return JSON.stringify(JSON.parse(e))}catch{return e}}export{W as TryView};
