#pragma once

#include <map>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/query/part_query.h"
#include "core/scene/part.h"
#include "tests/bench/method.h"

namespace passung::bench {

/// A part built as a scene builds it, with what that took; when it was built, if an earlier run kept it.
struct BuiltPart {
    scene::Part part;
    double field_s = 0.0, shell_s = 0.0;  // wall time, all cores; import not included
    double bytes() const;
};

/// Builds parts from triangles once per setting and keeps them from run to run; 0: no field, no shell.
class PartStore {
public:
    explicit PartStore(geometry::TriangleMesh mesh);
    ~PartStore();
    PartStore(const PartStore&) = delete;
    PartStore& operator=(const PartStore&) = delete;

    /// The field by tolerance [m], the shell by spacing [m].
    Result<const BuiltPart*> get(double tolerance, double spacing);

    /// The field by its cell [m], built here and now.
    Result<BuiltPart> withCell(double cell) const;

private:
    Result<scene::Part> build(const scene::PartNeeds& needs, scene::BuildStore* store) const;

    std::string file_;  // parts come from files
    std::unique_ptr<scene::BuildStore> kept_;
    std::map<std::pair<double, double>, BuiltPart> parts_;
};

/// The whole query with its proven bounds, as `passung query` answers it. The parts must outlive the method.
Candidate ourQuery(const BuiltPart& field, const BuiltPart& shell, double tolerance, double spacing,
                   const query::PartQueryRequest& request);

/// What one tick of the penalty method does: all points inside, no proof.
Candidate ourTick(const BuiltPart& field, const BuiltPart& shell, double tolerance, double spacing);

}  // namespace passung::bench
