#include "easypbr/drawing/polylines.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace easypbr::drawing {
namespace {

double distance_to_segment(const Vec2d& p, const Vec2d& a, const Vec2d& b) {
    const double length = (b - a).squaredNorm();
    const double t = length > 0 ? std::clamp((p - a).dot(b - a) / length, 0.0, 1.0) : 0;
    return (p - a - t * (b - a)).norm();
}

Polyline simplified(const Polyline& line, double tolerance) {
    std::vector<char> kept(line.size(), 0);
    kept.front() = kept.back() = 1;
    std::vector<std::pair<size_t, size_t>> left{{0, line.size() - 1}};
    while (!left.empty()) {
        const auto [begin, end] = left.back();
        left.pop_back();
        size_t farthest = begin;
        double most = tolerance;
        for (size_t i = begin + 1; i < end; ++i) {
            const double distance = distance_to_segment(line[i], line[begin], line[end]);
            if (distance > most) std::tie(farthest, most) = std::pair(i, distance);
        }
        if (farthest == begin) continue;
        kept[farthest] = 1;
        left.emplace_back(begin, farthest);
        left.emplace_back(farthest, end);
    }
    Polyline out;
    for (size_t i = 0; i < line.size(); ++i)
        if (kept[i]) out.push_back(line[i]);
    return out;
}

class Joiner {
  public:
    explicit Joiner(const std::vector<Piece>& pieces) : pieces_(pieces), used_(pieces.size(), 0) {
        for (size_t i = 0; i < pieces.size(); ++i)
            for (const int32_t place : pieces[i].places)
                if (place >= 0) at_[place].push_back(i);
    }

    std::vector<Polyline> join() {
        std::vector<Polyline> lines;
        // Those that begin at an end of a line, then what is left: closed ones.
        for (const bool closed : {false, true})
            for (size_t i = 0; i < pieces_.size(); ++i)
                for (int end = 0; end < 2; ++end)
                    if (!used_[i] && (closed || !goes_on(pieces_[i].places[size_t(end)])))
                        lines.push_back(line_from(i, end));
        return lines;
    }

  private:
    bool goes_on(int32_t place) const { return place >= 0 && at_.at(place).size() == 2; }

    Polyline line_from(size_t piece, int end) {
        Polyline line{end == 0 ? pieces_[piece].points.front() : pieces_[piece].points.back()};
        for (;;) {
            used_[piece] = 1;
            append(line, pieces_[piece].points, end == 1);
            const int32_t place = pieces_[piece].places[size_t(1 - end)];
            if (!goes_on(place)) return line;
            const std::vector<size_t>& two = at_.at(place);
            piece = two[0] == piece ? two[1] : two[0];
            if (used_[piece]) return line;
            end = pieces_[piece].places[0] == place ? 0 : 1;
        }
    }

    /// But for the first point, which is the line's last.
    static void append(Polyline& line, const Polyline& points, bool reversed) {
        if (reversed)
            line.insert(line.end(), points.rbegin() + 1, points.rend());
        else
            line.insert(line.end(), points.begin() + 1, points.end());
    }

    const std::vector<Piece>& pieces_;
    std::vector<char> used_;
    std::unordered_map<int32_t, std::vector<size_t>> at_;
};

}  // namespace

std::vector<Polyline> joined(const std::vector<Piece>& pieces, double tolerance) {
    std::vector<Polyline> lines = Joiner(pieces).join();
    for (Polyline& line : lines) line = simplified(line, tolerance);
    return lines;
}

}  // namespace easypbr::drawing
