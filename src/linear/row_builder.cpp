#include "linear/row_builder.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <algorithm>
#include <string>
#include <tuple>

#include "base/errors.hpp"

namespace lockstep {

namespace {
auto raw(const char* name) {
  return Kokkos::view_alloc(std::string(name), Kokkos::WithoutInitializing);
}
}  // namespace

/// The arrays that the matrix will keep, filled in place.
struct RowBuilder::Arrays {
  using Local = CrsMatrix::local_matrix_device_type;
  typename Local::row_map_type::non_const_type starts;
  typename Local::index_type::non_const_type columns;
  typename Local::values_type::non_const_type values;
};

RowBuilder::RowBuilder(const RCP<const Map>& map, int entries_per_row)
    : RowBuilder(map, map, entries_per_row) {}

RowBuilder::RowBuilder(const RCP<const Map>& rows, const RCP<const Map>& domain,
                       int entries_per_row)
    : rows_(rows),
      domain_(domain),
      is_square_(rows.get() == domain.get()),
      is_contiguous_(domain->isContiguous()),
      first_(domain->getMinGlobalIndex()),
      n_rows_(static_cast<int>(rows->getNodeNumElements())),
      n_own_(static_cast<int>(domain->getNodeNumElements())),
      arrays_(std::make_unique<Arrays>()) {
  arrays_->starts = decltype(arrays_->starts)(raw("starts"), n_rows_ + 1);
  starts_ = arrays_->starts.data();
  starts_[0] = 0;
  reserve(static_cast<std::size_t>(n_rows_) * entries_per_row);
}

RowBuilder::~RowBuilder() = default;

void RowBuilder::reserve(std::size_t n_entries) {
  if (n_entries <= capacity_)
    return;
  decltype(arrays_->columns) columns(raw("columns"), n_entries);
  decltype(arrays_->values) values(raw("values"), n_entries);
  std::copy(columns_, columns_ + size_, columns.data());
  std::copy(values_, values_ + size_, values.data());
  arrays_->columns = columns;
  arrays_->values = values;
  columns_ = columns.data();
  values_ = values.data();
  capacity_ = n_entries;
}

int RowBuilder::column(GlobalIndex id) {
  if (!is_square_)
    return named(id);
  if (is_contiguous_) {
    const GlobalIndex local = id - first_;
    return local >= 0 && local < n_own_ ? static_cast<int>(local) : named(id);
  }
  const int local = domain_->getLocalElement(id);
  return local >= 0 ? local : named(id);
}

int RowBuilder::named(GlobalIndex id) {
  const auto [entry, is_new] = place_.emplace(id, static_cast<int>(named_.size()));
  if (is_new)
    named_.push_back(id);
  return n_numbered() + entry->second;
}

std::size_t RowBuilder::add_at(int column, double value) {
  if (size_ == capacity_)
    reserve(std::max<std::size_t>(64, 2 * capacity_));
  columns_[size_] = column;
  values_[size_] = value;
  return size_++;
}

/// Sorts the entries by column; entries of one column keep their order.
void RowBuilder::sort(std::size_t begin, std::size_t end) {
  constexpr std::size_t short_row = 32;
  if (std::is_sorted(columns_ + begin, columns_ + end))
    return;
  if (end - begin <= short_row) {
    for (std::size_t i = begin + 1; i < end; ++i)
      for (std::size_t j = i; j > begin && columns_[j] < columns_[j - 1]; --j) {
        std::swap(columns_[j], columns_[j - 1]);
        std::swap(values_[j], values_[j - 1]);
      }
    return;
  }
  scratch_.clear();
  for (std::size_t i = begin; i < end; ++i)
    scratch_.emplace_back(columns_[i], values_[i]);
  std::stable_sort(scratch_.begin(), scratch_.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = begin; i < end; ++i)
    std::tie(columns_[i], values_[i]) = scratch_[i - begin];
}

void RowBuilder::end_row() {
  const std::size_t begin = starts_[row_];
  sort(begin, size_);
  std::size_t kept = begin;
  for (std::size_t i = begin; i < size_; ++i) {
    if (kept > begin && columns_[kept - 1] == columns_[i]) {
      values_[kept - 1] += values_[i];
      continue;
    }
    columns_[kept] = columns_[i];
    values_[kept++] = values_[i];
  }
  size_ = kept;
  starts_[++row_] = size_;
}

std::vector<std::pair<int, GlobalIndex>> RowBuilder::by_owner() const {
  // Ids of contiguous maps ascend with the rank, so that nobody need be asked.
  std::vector<int> owners(named_.size(), 0);
  if (!is_contiguous_)
    domain_->getRemoteIndexList(Teuchos::arrayViewFromVector(named_),
                                Teuchos::arrayViewFromVector(owners));
  std::vector<std::pair<int, GlobalIndex>> sorted;
  for (std::size_t i = 0; i < named_.size(); ++i) {
    const bool is_own = domain_->isNodeGlobalElement(named_[i]);
    sorted.emplace_back(is_own ? -1 : owners[i], named_[i]);
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

std::vector<GlobalIndex> RowBuilder::number_named() {
  std::vector<GlobalIndex> ids(n_numbered());
  const auto own = domain_->getNodeElementList();
  std::copy(own.begin(), own.begin() + n_numbered(), ids.begin());
  const int first = n_numbered();
  std::vector<int> number(named_.size());
  for (const auto& [owner, id] : by_owner()) {
    number[place_.at(id)] = static_cast<int>(ids.size());
    ids.push_back(id);
  }
  for (std::size_t i = 0; i < size_; ++i) {
    if (columns_[i] >= first)
      columns_[i] = number[columns_[i] - first];
  }
  return ids;
}

RCP<CrsMatrix> RowBuilder::finish() {
  LOCKSTEP_ASSERT(row_ == n_rows_);
  RCP<const Map> column_map = domain_;
  RCP<const Import> importer;
  // Rows that keep to their ranks, as those of rigid bodies do, need no map of their own: a map and
  // an import take many collectives.
  const Communicator comm = domain_->getComm();
  const bool is_local = is_square_ && sum_all(comm, static_cast<GlobalIndex>(named_.size())) == 0;
  if (!is_local) {
    const std::vector<GlobalIndex> ids = number_named();
    for (int row = 0; row < n_rows_ && !named_.empty(); ++row)
      sort(starts_[row], starts_[row + 1]);
    const auto unknown = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
    column_map = rcp(new Map(unknown, Teuchos::arrayViewFromVector(ids), 0, comm));
    importer = rcp(new Import(domain_, column_map));
  }
  const auto used = std::make_pair(std::size_t(0), size_);
  const auto matrix =
      rcp(new CrsMatrix(rows_, column_map, arrays_->starts, Kokkos::subview(arrays_->columns, used),
                        Kokkos::subview(arrays_->values, used)));
  matrix->expertStaticFillComplete(domain_, rows_, importer);
  return matrix;
}

}  // namespace lockstep
