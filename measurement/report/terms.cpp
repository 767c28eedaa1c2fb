#include "measurement/report/phrases.h"

#include <algorithm>
#include <utility>

namespace tarsus::phrase {
namespace {

struct Term {
  std::string_view word;
  Phrase said;
};

// The words of the record's fields (visit_fields.cpp, wounds.h) and of the scores' components.
// clang-format off
constexpr Term kTerms[] = {
  {"granulation", {"granulation", "Granulation", "granulation", "granulación", "肉芽"}},
  {"slough", {"slough", "Belag", "fibrine", "esfacelo", "腐肉"}},
  {"necrosis", {"necrosis", "Nekrose", "nécrose", "necrosis", "坏死"}},
  {"epithelium", {"epithelium", "Epithel", "épithélium", "epitelio", "上皮"}},
  {"other", {"other", "anderes", "autre", "otro", "其他"}},
  {"exudate_amount", {"exudate", "Exsudat", "exsudat", "exudado", "渗液量"}},
  {"exudate_type", {"exudate type", "Exsudatart", "type d’exsudat", "tipo de exudado", "渗液性质"}},
  {"exudate_odour", {"odour", "Geruch", "odeur", "olor", "气味"}},
  {"edge", {"edge", "Rand", "berges", "borde", "边缘"}},
  {"callus", {"callus", "Schwiele", "cal", "callo", "胼胝"}},
  {"periwound", {"periwound", "Umgebung", "pourtour", "piel circundante", "创周"}},
  {"pain_of_10", {"pain, of 10", "Schmerz, von 10", "douleur, sur 10", "dolor, de 10", "疼痛（0–10）"}},
  {"debridement", {"debrided", "Débridement", "détersion", "desbridamiento", "清创"}},
  {"offloading", {"offloading", "Entlastung", "décharge", "descarga", "减压"}},
  {"offloading_adherence", {"worn", "getragen", "portée", "uso", "佩戴"}},
  {"dressing", {"dressing", "Verband", "pansement", "apósito", "敷料"}},
  {"none", {"none", "keine", "aucun", "ninguno", "无"}},
  {"light", {"light", "gering", "faible", "leve", "少量"}},
  {"moderate", {"moderate", "mäßig", "modéré", "moderado", "中等"}},
  {"heavy", {"heavy", "stark", "abondant", "abundante", "大量"}},
  {"serous", {"serous", "serös", "séreux", "seroso", "浆液性"}},
  {"sanguineous", {"sanguineous", "blutig", "sanglant", "sanguinolento", "血性"}},
  {"serosanguineous", {"serosanguineous", "serös-blutig", "séro-sanglant", "serosanguinolento", "血清性"}},
  {"purulent", {"purulent", "eitrig", "purulent", "purulento", "脓性"}},
  {"faint", {"faint", "schwach", "légère", "leve", "轻微"}},
  {"strong", {"strong", "stark", "forte", "fuerte", "明显"}},
  {"flat", {"flat", "flach", "plates", "plano", "平坦"}},
  {"sloping", {"sloping", "abfallend", "en pente", "en pendiente", "斜坡"}},
  {"punched_out", {"punched out", "ausgestanzt", "à l’emporte-pièce", "en sacabocados", "凿状"}},
  {"rolled", {"rolled", "gewulstet", "enroulées", "enrollado", "卷边"}},
  {"undermined", {"undermined", "unterminiert", "décollées", "socavado", "潜行"}},
  {"thick", {"thick", "dick", "épais", "grueso", "厚"}},
  {"healthy", {"healthy", "gesund", "sain", "sano", "健康"}},
  {"red", {"red", "gerötet", "rouge", "rojo", "发红"}},
  {"macerated", {"macerated", "mazeriert", "macéré", "macerado", "浸渍"}},
  {"dry", {"dry", "trocken", "sec", "seco", "干燥"}},
  {"eczema", {"eczema", "Ekzem", "eczéma", "eccema", "湿疹"}},
  {"swollen", {"swollen", "geschwollen", "gonflé", "hinchado", "肿胀"}},
  {"before_scan", {"before the scan", "vor der Aufnahme", "avant la numérisation", "antes del escaneo", "扫描前"}},
  {"after_scan", {"after the scan", "nach der Aufnahme", "après la numérisation", "después del escaneo", "扫描后"}},
  {"always", {"always", "immer", "toujours", "siempre", "始终"}},
  {"mostly", {"mostly", "meist", "le plus souvent", "casi siempre", "多数"}},
  {"sometimes", {"sometimes", "manchmal", "parfois", "a veces", "有时"}},
  {"never", {"never", "nie", "jamais", "nunca", "从不"}},
  {"plantar", {"plantar", "plantar", "plantaire", "plantar", "足底"}},
  {"dorsal", {"dorsal", "dorsal", "dorsal", "dorsal", "足背"}},
  {"medial", {"medial", "medial", "médial", "medial", "内侧"}},
  {"lateral", {"lateral", "lateral", "latéral", "lateral", "外侧"}},
  {"interdigital", {"interdigital", "interdigital", "interdigital", "interdigital", "趾间"}},
  {"midfoot", {"midfoot", "Mittelfuß", "médio-pied", "mediopié", "中足"}},
  {"hindfoot", {"hindfoot", "Rückfuß", "arrière-pied", "retropié", "后足"}},
  {"forefoot", {"forefoot", "Vorfuß", "avant-pied", "antepié", "前足"}},
  {"heel", {"heel", "Ferse", "talon", "talón", "足跟"}},
  {"toe_1", {"toe 1", "1. Zehe", "1er orteil", "dedo 1", "第 1 趾"}},
  {"toe_2", {"toe 2", "2. Zehe", "2e orteil", "dedo 2", "第 2 趾"}},
  {"toe_3", {"toe 3", "3. Zehe", "3e orteil", "dedo 3", "第 3 趾"}},
  {"toe_4", {"toe 4", "4. Zehe", "4e orteil", "dedo 4", "第 4 趾"}},
  {"toe_5", {"toe 5", "5. Zehe", "5e orteil", "dedo 5", "第 5 趾"}},
  {"mth_1", {"metatarsal head 1", "Mittelfußköpfchen 1", "tête métatarsienne 1", "cabeza metatarsiana 1", "第 1 跖骨头"}},
  {"mth_2", {"metatarsal head 2", "Mittelfußköpfchen 2", "tête métatarsienne 2", "cabeza metatarsiana 2", "第 2 跖骨头"}},
  {"mth_3", {"metatarsal head 3", "Mittelfußköpfchen 3", "tête métatarsienne 3", "cabeza metatarsiana 3", "第 3 跖骨头"}},
  {"mth_4", {"metatarsal head 4", "Mittelfußköpfchen 4", "tête métatarsienne 4", "cabeza metatarsiana 4", "第 4 跖骨头"}},
  {"mth_5", {"metatarsal head 5", "Mittelfußköpfchen 5", "tête métatarsienne 5", "cabeza metatarsiana 5", "第 5 跖骨头"}},
  {"neuropathic", {"neuropathic", "neuropathisch", "neuropathique", "neuropático", "神经性"}},
  {"ischaemic", {"ischaemic", "ischämisch", "ischémique", "isquémico", "缺血性"}},
  {"neuroischaemic", {"neuroischaemic", "neuroischämisch", "neuro-ischémique", "neuroisquémico", "神经缺血性"}},
  {"pressure", {"pressure", "Druck", "pression", "presión", "压力性"}},
  {"trauma", {"trauma", "Trauma", "traumatisme", "traumatismo", "外伤"}},
  // Scores
  {"site", {"site", "Ort", "site", "lugar", "部位"}},
  {"ischaemia", {"ischaemia", "Ischämie", "ischémie", "isquemia", "缺血"}},
  {"neuropathy", {"neuropathy", "Neuropathie", "neuropathie", "neuropatía", "神经病变"}},
  {"infection", {"infection", "Infektion", "infection", "infección", "感染"}},
  {"foot infection", {"foot infection", "Fußinfektion", "infection du pied", "infección del pie", "足部感染"}},
  {"wound", {"wound", "Wunde", "plaie", "herida", "创面"}},
  {"area", {"area", "Fläche", "surface", "área", "面积"}},
  {"area_cm2", {"area", "Fläche", "surface", "área", "面积"}},
  {"depth", {"depth", "Tiefe", "profondeur", "profundidad", "深度"}},
  {"grade", {"grade", "Grad", "grade", "grado", "级别"}},
  {"size", {"size", "Größe", "taille", "tamaño", "大小"}},
  {"exudate", {"exudate", "Exsudat", "exsudat", "exudado", "渗液"}},
  {"tissue", {"tissue", "Gewebe", "tissu", "tejido", "组织"}},
  {"midfoot or hindfoot", {"midfoot or hindfoot", "Mittel- oder Rückfuß", "médio- ou arrière-pied", "medio- o retropié", "中足或后足"}},
  {"a pedal pulse is felt", {"a pedal pulse is felt", "Fußpuls tastbar", "pouls pédieux perçu", "pulso pedio palpable", "可触及足背搏动"}},
  {"pedal blood flow reduced", {"pedal blood flow reduced", "Durchblutung vermindert", "flux réduit", "flujo reducido", "足部血流减少"}},
  {"sensation intact", {"sensation intact", "Empfinden erhalten", "sensibilité intacte", "sensibilidad intacta", "感觉完好"}},
  {"sensation lost", {"sensation lost", "Empfinden verloren", "sensibilité perdue", "sensibilidad perdida", "感觉丧失"}},
  {"no bacterial infection", {"no bacterial infection", "keine bakterielle Infektion", "pas d’infection bactérienne", "sin infección bacteriana", "无细菌感染"}},
  {"bacterial infection", {"bacterial infection", "bakterielle Infektion", "infection bactérienne", "infección bacteriana", "细菌感染"}},
  {"under 1 cm2", {"under 1 cm²", "unter 1 cm²", "moins de 1 cm²", "menos de 1 cm²", "小于 1 cm²"}},
  {"1 cm2 or more", {"1 cm² or more", "1 cm² oder mehr", "1 cm² ou plus", "1 cm² o más", "1 cm² 及以上"}},
  {"skin and subcutis", {"skin and subcutis", "Haut und Subkutis", "peau et hypoderme", "piel y subcutis", "皮肤与皮下"}},
  {"muscle, tendon or deeper", {"muscle, tendon or deeper", "Muskel, Sehne oder tiefer", "muscle, tendon ou plus profond", "músculo, tendón o más profundo", "肌肉、肌腱或更深"}},
  {"no", {"no", "nein", "non", "no", "否"}},
  {"yes", {"yes", "ja", "oui", "sí", "是"}},
  {"swelling or induration", {"swelling or induration", "Schwellung oder Verhärtung", "œdème ou induration", "hinchazón o induración", "肿胀或硬结"}},
  {"erythema", {"erythema", "Rötung", "érythème", "eritema", "红斑"}},
  {"tenderness or pain", {"tenderness or pain", "Schmerz", "douleur", "dolor", "压痛或疼痛"}},
  {"warmth", {"warmth", "Wärme", "chaleur", "calor", "皮温升高"}},
  {"pus", {"pus", "Eiter", "pus", "pus", "脓"}},
  {"osteomyelitis", {"osteomyelitis", "Osteomyelitis", "ostéomyélite", "osteomielitis", "骨髓炎"}},
  {"uninfected", {"uninfected", "nicht infiziert", "non infecté", "sin infección", "无感染"}},
  {"0.5 cm or less", {"0.5 cm or less", "0,5 cm oder weniger", "0,5 cm ou moins", "0,5 cm o menos", "0.5 cm 及以下"}},
  {"over 0.5 cm", {"over 0.5 cm", "über 0,5 cm", "plus de 0,5 cm", "más de 0,5 cm", "超过 0.5 cm"}},
};
// clang-format on

}  // namespace

const Phrase* termNamed(std::string_view word) {
  const auto* found =
      std::ranges::find_if(kTerms, [&](const Term& term) { return term.word == word; });
  return found == std::end(kTerms) ? nullptr : &found->said;
}

}  // namespace tarsus::phrase
